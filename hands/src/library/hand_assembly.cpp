#include "library/hand_assembly.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "derive/derivation.hpp"
#include "derive/sidecar_resolution.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/json_bounds.hpp"
#include "graspfit/base/path_text.hpp"
#include "graspfit/base/sha256.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "import/hand_tree.hpp"
#include "import/link_surfaces.hpp"
#include "import/robot_file.hpp"
#include "model/hand_size.hpp"

namespace graspfit::hands::internal {

namespace {

namespace fs = std::filesystem;
using base::InvalidInput;
using base::IoError;

void require_file(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) throw IoError(file.string() + ": no such hand description");
  if (!fs::is_regular_file(file, error)) throw IoError(file.string() + ": is not a file");
}

}  // namespace

HandSources read_sources(const fs::path& description_file, Findings& findings) {
  require_file(description_file);
  const std::string file = description_file.string();
  const std::string text = base::read_file(description_file);
  HandSources sources;
  const bool is_robot = findings.attempt(
      [&] { sources.description = parse_robot_file(text, description_file, findings); });
  if (!is_robot) return sources;
  const std::vector<DescribedLink>& links = sources.description.links;

  const fs::path sidecar_file = sidecar_file_of(description_file);
  std::error_code error;
  std::string sidecar_text;
  const bool has_sidecar = fs::exists(sidecar_file, error);
  if (has_sidecar) {
    findings.attempt([&] {
      if (!fs::is_regular_file(sidecar_file, error)) {
        throw IoError(sidecar_file.string() + ": is not a file");
      }
      sidecar_text = base::read_json_file(sidecar_file);
      sources.sidecar = parse_sidecar(sidecar_text, sidecar_file.string());
    });
  }
  // An unknown link is left for `resolved` to complain about.
  std::optional<std::string> palm_link;
  for (const DescribedLink& link : links) {
    if (sources.sidecar.palm && sources.sidecar.palm->link == link.name) palm_link = link.name;
  }
  findings.attempt(
      [&] { sources.tree = build_tree(sources.description, file, palm_link, findings); });
  if (sources.tree) {
    HandModel& tree = *sources.tree;
    tree.description_file = file;
    tree.description_sha256 = base::sha256_hex(text);
    if (has_sidecar) {
      tree.sidecar_file = sidecar_file.string();
      tree.sidecar_sha256 = base::sha256_hex(sidecar_text);
    }
    findings.attempt([&] {
      const auto& couplings = sources.sidecar.couplings;
      if (couplings) set_couplings(*couplings, sidecar_file.string(), tree);
      follow_first_leaders(couplings && !couplings->empty() ? sidecar_file.string() : file, tree);
    });
  }
  for (const DescribedLink& source : links) {
    Link* link = nullptr;  // without a tree meshes are read too: missing ones are reported at once
    if (sources.tree) {
      const auto found =
          std::find_if(sources.tree->links.begin(), sources.tree->links.end(),
                       [&](const Link& candidate) { return candidate.name == source.name; });
      if (found == sources.tree->links.end()) continue;  // the link is before the palm and left out
      link = &*found;
    }
    findings.attempt(
        [&] {
          LinkSurface surface = read_link_surface(source, description_file, findings);
          if (!link) return;
          link->mesh_L = std::move(surface.mesh_L);
          link->mesh_files = std::move(surface.mesh_files);
        },
        "link " + source.name);
  }
  // After faults of the tree there may be limits and couplings that no configuration satisfies.
  if (sources.tree && !findings.has_faults()) {
    findings.attempt(
        [&] { check_size(*sources.tree, sources.description.meters_per_unit, findings); });
  }
  return sources;
}

std::string completed_sidecar_text(const HandSources& sources, Findings& findings) {
  const HandModel& tree = *sources.tree;
  const std::string description =
      sources.sidecar.description.empty()
          ? "Derived by graspfit from " +
                base::path_text(fs::path(tree.description_file).filename().string()) +
                "; edit what is wrong, delete a member to derive it again."
          : sources.sidecar.description;
  return sidecar_text(completed(tree, sources.sidecar, findings), tree.name, description);
}

std::optional<HandModel> assemble(const HandSources& sources, Findings& findings) {
  // After a fault names can still be checked, but nothing sensible can be derived.
  if (!sources.tree || (findings.has_faults() && !sources.sidecar.is_complete())) {
    return std::nullopt;
  }
  HandModel model = *sources.tree;
  const std::string file = model.sidecar_file.empty() ? model.description_file : model.sidecar_file;
  const bool is_whole = findings.attempt([&] {
    Sidecar sidecar = sources.sidecar;
    if (!sidecar.is_complete()) {
      // The derived sidecar is written as text and parsed, so that the hand is the same once the
      // text is a file.
      const std::string text = completed_sidecar_text(sources, findings);
      sidecar = parse_sidecar(text, file + " (derived)");
      model.sidecar_sha256 = base::sha256_hex(text);
    }
    model = resolved(sidecar, file, std::move(model));
    try {
      validate(model);
    } catch (const InvalidInput& invalid) {
      throw InvalidInput(file + ": " + invalid.what());
    }
  });
  if (!is_whole || findings.has_faults()) return std::nullopt;
  return model;
}

}  // namespace graspfit::hands::internal
