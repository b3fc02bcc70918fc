#include "graspfit/hands/hand_io.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"
#include "internal/derivation.hpp"
#include "internal/findings.hpp"
#include "internal/hand_tree.hpp"
#include "internal/link_surfaces.hpp"
#include "internal/robot_file.hpp"
#include "internal/sidecar.hpp"
#include "internal/sidecar_resolution.hpp"

namespace graspfit::hands {

namespace {

namespace fs = std::filesystem;
using geometry::InvalidInput;
using geometry::IoError;
using internal::Findings;

/// The tree with surfaces, and what the sidecar beside it says, if there is one.
struct Sources {
  HandModel tree;
  internal::Sidecar sidecar;
  std::string sidecar_text;  ///< Empty without a sidecar.
};

void require_file(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) throw IoError(file.string() + ": no such hand description");
  if (!fs::is_regular_file(file, error)) throw IoError(file.string() + ": is not a file");
}

Sources read_sources(const fs::path& description_file, Findings& findings) {
  require_file(description_file);
  const std::string file = description_file.string();
  const std::string text = geometry::read_file(description_file);
  const internal::RobotDescription description =
      internal::parse_robot_file(text, description_file, findings);
  Sources sources;
  const fs::path sidecar_file = sidecar_file_of(description_file);
  std::error_code error;
  const bool has_sidecar = fs::is_regular_file(sidecar_file, error);
  if (has_sidecar) {
    sources.sidecar_text = geometry::read_file(sidecar_file);
    sources.sidecar = internal::parse_sidecar(sources.sidecar_text, sidecar_file.string());
  }
  // An unknown link is left for `resolve` to complain about.
  std::optional<std::string> palm_link;
  for (const internal::DescribedLink& link : description.links) {
    if (sources.sidecar.palm && sources.sidecar.palm->link == link.name) palm_link = link.name;
  }
  sources.tree = internal::build_tree(description, file, palm_link, findings);
  sources.tree.description_file = file;
  sources.tree.description_sha256 = geometry::sha256_hex(text);
  if (has_sidecar) {
    sources.tree.sidecar_file = sidecar_file.string();
    sources.tree.sidecar_sha256 = geometry::sha256_hex(sources.sidecar_text);
  }
  if (sources.sidecar.couplings) {
    internal::set_couplings(*sources.sidecar.couplings, sidecar_file.string(), sources.tree);
  }
  internal::follow_first_leaders(file, sources.tree);

  for (const internal::DescribedLink& source : description.links) {
    const auto link =
        std::find_if(sources.tree.links.begin(), sources.tree.links.end(),
                     [&](const Link& candidate) { return candidate.name == source.name; });
    if (link == sources.tree.links.end()) continue;  // left out before the palm
    findings.attempt(
        [&] { internal::read_link_surface(source, description_file, *link, findings); });
  }
  return sources;
}

/// The whole hand from its sources: what no sidecar says is derived.
HandReading assemble(const fs::path& description_file, Findings& findings) {
  Sources sources = read_sources(description_file, findings);
  HandReading reading;
  reading.description = sources.sidecar.description;
  HandModel& model = reading.model;
  model = sources.tree;
  const std::string file =
      model.sidecar_file.empty() ? description_file.string() : model.sidecar_file;
  internal::Sidecar sidecar = sources.sidecar;
  if (!sidecar.is_complete()) {
    sidecar = internal::completed(sources.tree, sidecar, findings);
    model.sidecar_sha256 = geometry::sha256_hex(internal::sidecar_text(sidecar, model.name, ""));
  }
  internal::resolve(sidecar, file, model);
  try {
    validate(model);
  } catch (const InvalidInput& invalid) {
    throw InvalidInput(file + ": " + invalid.what());
  }
  return reading;
}

}  // namespace

fs::path sidecar_file_of(const fs::path& description_file) {
  return fs::path(description_file).replace_extension(".graspfit.json");
}

HandReading read_hand(const fs::path& description_file) {
  Findings findings(Findings::AtFault::Throw);
  HandReading reading = assemble(description_file, findings);
  reading.findings = findings.list();
  return reading;
}

HandModel read_hand_model(const fs::path& description_file) {
  return read_hand(description_file).model;
}

std::string derived_sidecar_text(const fs::path& description_file) {
  Findings findings(Findings::AtFault::Throw);
  const Sources sources = read_sources(description_file, findings);
  const std::string description =
      sources.sidecar.description.empty()
          ? "Derived by graspfit from " + description_file.filename().string() +
                "; edit what is wrong, delete a member to derive it again."
          : sources.sidecar.description;
  return internal::sidecar_text(internal::completed(sources.tree, sources.sidecar, findings),
                                sources.tree.name, description);
}

}  // namespace graspfit::hands
