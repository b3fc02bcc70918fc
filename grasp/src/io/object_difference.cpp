#include "graspfit/grasp/object_difference.hpp"

#include <cmath>
#include <filesystem>
#include <map>
#include <vector>

#include "graspfit/base/number_text.hpp"

namespace graspfit::grasp {
namespace {

/// "filled 5 holes" of "filled holes" and 5: verb, count, what.
std::string in_words(const std::string& what, std::size_t count) {
  const std::size_t space = what.find(' ');
  if (space == std::string::npos) return what;
  std::string things = what.substr(space + 1);
  const std::string kVertices = "vertices";
  if (count == 1 && things.ends_with(kVertices)) {
    things.replace(things.size() - kVertices.size(), kVertices.size(), "vertex");
  } else if (count == 1) {
    things.pop_back();
  }
  return what.substr(0, space + 1) + std::to_string(count) + ' ' + things;
}

/// "2.1 %", with its sign if asked for.
std::string percent(double share, bool has_sign) {
  const double rounded = std::round(1000.0 * share) / 10.0;
  return (has_sign && rounded > 0.0 ? "+" : "") +
         base::shortest_decimal(rounded == 0.0 ? 0.0 : rounded) + " %";
}

}  // namespace

std::optional<std::string> difference_from_file(const ObjectRecord& object,
                                                const DifferenceLimits& limits) {
  std::vector<std::string> names;
  std::map<std::string, std::size_t> counts;
  double volume = 0.0;
  double surface = 0.0;
  for (const geometry::RepairStep& step : object.repairs) {
    if (!(step.hausdorff_bound > 0.0)) continue;
    if (counts[step.what] == 0) names.push_back(step.what);
    counts[step.what] += step.count;
    volume += step.volume_change;
    surface += step.hausdorff_bound;
  }
  const double extent =
      object.analysis.box.isEmpty() ? 0.0 : object.analysis.box.sizes().maxCoeff();
  if (names.empty() || !(object.volume > 0.0) || !(extent > 0.0)) return std::nullopt;
  const double volume_rel = volume / object.volume;
  const double surface_rel = surface / extent;
  if (std::abs(volume_rel) <= limits.volume_rel && surface_rel <= limits.surface_rel) {
    return std::nullopt;
  }
  std::string steps;
  for (const std::string& name : names) {
    steps += (steps.empty() ? "" : ", ") + in_words(name, counts[name]);
  }
  return std::filesystem::path(object.file).filename().string() +
         ": the solid differs from the file: " + steps + " (volume " + percent(volume_rel, true) +
         ", surface up to " + percent(surface_rel, false) + " of the extent)";
}

std::optional<std::string> reason_against_wrap(const ObjectRecord& object) {
  if (!object.repair.wrap) return std::nullopt;
  std::size_t num_filled = 0;
  for (const geometry::RepairStep& step : object.repairs) {
    if (step.what == "wrapped") return std::nullopt;
    if (step.what == "filled holes") num_filled += step.count;
  }
  const std::string text = "--wrap: ";
  if (object.repair.mode != geometry::RepairMode::Repair) {
    return text + "not made: only --repair repair changes the mesh";
  }
  if (num_filled > 0) {
    return text + "not needed: the mesh was closed by filling " + std::to_string(num_filled) +
           (num_filled == 1 ? " hole" : " holes");
  }
  return text + (object.repairs.empty() ? "not needed: the mesh is closed as it is"
                                        : "not needed: the mesh was mended without it");
}

}  // namespace graspfit::grasp
