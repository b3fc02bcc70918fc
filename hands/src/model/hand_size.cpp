#include "model/hand_size.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "model/finding_text.hpp"

namespace graspfit::hands::internal {

namespace {

constexpr double kSmallestHand = 0.01;  // [m]
constexpr double kFarthest = 1e4;       // [m]

/// A unit that lengths may have been given in where meters are read.
struct Unit {
  const char* name;
  double meters;
};
constexpr std::array<Unit, 3> kUnits = {
    {{"millimeters", 1e-3}, {"centimeters", 1e-2}, {"inches", 0.0254}}};

/// The unit with which this extent is that of a hand. If the extent is too large, lengths in this
/// unit were read as meters; if it is too small, lengths in meters were taken for this unit.
std::optional<Unit> likely_unit(double extent) {
  constexpr double kTypical = 0.15;     // [m]
  constexpr double kWithinRatio = 3.5;  // grippers of 5 cm, hands with a forearm of 50 cm
  std::optional<Unit> likely;
  double nearest = std::log(kWithinRatio);
  for (const Unit& unit : kUnits) {
    const double meant = extent > kLargestHand ? extent * unit.meters : extent / unit.meters;
    const double ratio = std::abs(std::log(meant / kTypical));
    if (!(ratio < nearest)) continue;
    nearest = ratio;
    likely = unit;
  }
  return likely;
}

std::string scale_text(double factor) {
  const std::string number = rounded(factor);
  return "scale=\"" + number + ' ' + number + ' ' + number + '"';
}

}  // namespace

double extent_at_rest(const HandModel& tree) {
  const auto X_HL = forward_kinematics(tree, open_configuration(tree));
  Eigen::AlignedBox3d box;
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    for (const Eigen::Vector3d& vertex : tree.links[l].mesh_L.vertices) {
      box.extend(X_HL[l] * vertex);
    }
  }
  return box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
}

void check_size(const HandModel& tree, double meters_per_unit, Findings& findings) {
  const double extent = extent_at_rest(tree);
  if (extent == 0.0) return;
  // Written so that NaN fails.
  if (!(extent <= kFarthest)) {
    throw base::InvalidInput(tree.description_file + ": its links span " + rounded(extent) +
                             " m; hands are read up to " + base::plain_decimal(kFarthest) +
                             " m: are its lengths in the unit of its format?");
  }
  const bool is_large = extent > kLargestHand;
  if (!is_large && extent >= kSmallestHand) return;
  const bool has_meters = meters_per_unit == 1.0;
  const std::string size = "its links span " + rounded(extent) + " m";
  const std::string read_as = has_meters ? "meters" : "millimeters";
  const std::optional<Unit> unit = likely_unit(extent);
  if (!unit) {
    findings.suspicious("", size + ", which no hand does: are its lengths " + read_as + "?");
    return;
  }
  const std::string much = ", " + base::plain_decimal(std::round(10.0 / unit->meters) / 10.0) +
                           " times too " + (is_large ? "large" : "small") + " for a hand: ";
  std::string why;
  if (!has_meters) {
    why = "this format has millimeters; are its lengths in another unit?";
  } else if (is_large) {
    why = std::string("are its lengths ") + unit->name + "? Write " + scale_text(unit->meters) +
          " into every <mesh>, and all other lengths (origins, sizes, limits of slides) in meters";
  } else {
    why = std::string("were its lengths taken for ") + unit->name + "? Leave out the " +
          scale_text(unit->meters) + " of its meshes, and give all lengths in meters";
  }
  findings.suspicious("", size + much + why);
}

}  // namespace graspfit::hands::internal
