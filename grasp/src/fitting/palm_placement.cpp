#include "graspfit/grasp/palm_placement.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "graspfit/geometry/angle.hpp"

namespace graspfit::grasp {
namespace {

using Eigen::Vector3d;

// More directions find better sides and cost a posture each.
constexpr int kDirectionsAroundAxis = 16;  // for two targets
constexpr int kPalmTurns = 8;              // about the palm's target, where the seed leaves it open
// A seed nearer than this to the palm's axis says nothing about how the hand is turned [m].
constexpr double kSeedOnAxis = 0.01;
// Radius of the palm about its center, for the space before it [m].
constexpr double kPalmRadius = 0.025;

/// Directions perpendicular to the line of two targets, or the two normals of the plane nearest to
/// more of them.
std::vector<Vector3d> finger_directions(const TargetContacts& targets) {
  std::vector<Vector3d> directions;
  if (targets.contacts.size() == 2) {
    const Vector3d axis = (targets.contacts[1].point_O - targets.contacts[0].point_O).normalized();
    const Vector3d first = axis.unitOrthogonal();
    for (int k = 0; k < kDirectionsAroundAxis; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kDirectionsAroundAxis;
      directions.push_back(Eigen::AngleAxisd(angle, axis) * first);
    }
    return directions;
  }
  const Vector3d center = targets.centroid();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const TargetContact& target : targets.contacts) {
    spread += (target.point_O - center) * (target.point_O - center).transpose();
  }
  // The eigenvalues come in increasing order: the first vector is the plane's normal.
  const Vector3d normal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0).normalized();
  return {normal, -normal};
}

/// How far the object sticks out against a direction from the targets' centroid [m].
struct Extent {
  double whole = 0.0;
  double before_palm = 0.0;  ///< Within the palm's radius of the line through the centroid.
};

/// The extents of the patches' centroids, so accurate to half a voxel's diagonal.
Extent extent_against(const ObjectModel& object, const Vector3d& center,
                      const Vector3d& direction) {
  Extent extent;
  for (const geometry::SurfacePatch& patch : object.patches) {
    const Vector3d out = center - patch.centroid;
    const double height = out.dot(direction);
    extent.whole = std::max(extent.whole, height);
    if (height <= extent.before_palm) continue;
    const bool is_before = out.squaredNorm() - height * height < kPalmRadius * kPalmRadius;
    if (is_before) extent.before_palm = height;
  }
  return extent;
}

}  // namespace

std::vector<PalmPlacement> palm_placements(const ObjectModel& object, const TargetContacts& targets,
                                           const std::optional<Vector3d>& approach_O,
                                           double approach_angle) {
  const Vector3d center = targets.centroid();
  const TargetContact& last = targets.contacts.back();
  const bool has_palm = last.is_palm;
  struct Ranked {
    double key;
    PalmPlacement placement;
  };
  std::vector<Ranked> ranked;
  std::vector<Vector3d> directions = {-last.outward_normal_O};
  if (!has_palm) directions = finger_directions(targets);
  for (const Vector3d& direction : directions) {
    const Extent extent = extent_against(object, center, direction);
    PalmPlacement placement;
    placement.direction_O = direction;
    if (!has_palm) placement.palm_distance = extent.before_palm;
    double key = extent.whole;
    if (approach_O) {
      key = geometry::angle_between(direction, *approach_O);
      if (key > approach_angle) continue;
    }
    ranked.push_back({key, placement});
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Ranked& a, const Ranked& b) { return a.key < b.key; });
  std::vector<PalmPlacement> placements;
  for (const Ranked& entry : ranked) placements.push_back(entry.placement);
  if (has_palm && !placements.empty()) {
    const Vector3d to_seed = targets.contacts.front().point_O - last.point_O;
    if (to_seed.cross(last.outward_normal_O).norm() < kSeedOnAxis) {
      for (int turn = 1; turn < kPalmTurns; ++turn) {
        placements.push_back(placements.front());
        placements.back().turn = 2.0 * std::numbers::pi * turn / kPalmTurns;
      }
    }
  }
  return placements;
}

}  // namespace graspfit::grasp
