#include "graspfit/hands/tip_reach.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/kinematic_chain.hpp"

namespace graspfit::hands {
namespace {

using Eigen::Vector3d;

constexpr double kCell = 0.006;  // [m] less than the width of any fingertip
// Width of the border around the visited cells [cells]: there, distances of points that a finger
// nearly reaches are looked up, not bounded.
constexpr int kBorder = 4;
constexpr double kMostCells = 0x1p26;  // 2.4 m cubed, in cells of 6 mm
constexpr int kMostSamples = 1 << 14;
constexpr int kMostPerJoint = 128;
// A pad faces along a direction if its normal is within 50 degrees of it.
constexpr double kCosLooking = 0.64278760968653936;

/// Directions to the faces and corners of a cube: every direction is within 35.3 degrees of one of
/// them, the angle between the middle of an edge and a corner.
std::vector<Vector3d> looking_directions() {
  std::vector<Vector3d> directions;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) directions.push_back(sign * Vector3d::Unit(axis));
  }
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      for (const double z : {-1.0, 1.0}) directions.push_back(Vector3d(x, y, z).normalized());
    }
  }
  return directions;
}

/// Index of the nearest of `looking_directions`: the face of the largest component, or the corner
/// given by the signs. Of equally near ones it is any.
std::size_t nearest_direction(const Vector3d& normal) {
  Eigen::Index axis = 0;
  const double to_face = normal.cwiseAbs().maxCoeff(&axis);
  const double to_corner = normal.lpNorm<1>() / std::numbers::sqrt3;
  if (to_face >= to_corner) {
    return 2 * static_cast<std::size_t>(axis) + (normal[axis] > 0.0 ? 1 : 0);
  }
  const auto bit = [&](int i) { return normal[i] > 0.0 ? std::size_t{1} : std::size_t{0}; };
  return 6 + 4 * bit(0) + 2 * bit(1) + bit(2);
}

std::vector<TipPose> tip_poses(const HandModel& model, const Finger& finger) {
  const std::vector<int> leaders = leaders_of(model, finger.joints);
  int per_joint = kMostPerJoint;
  const auto grid = [&](int n) { return std::pow(n, static_cast<double>(leaders.size())); };
  while (per_joint > 2 && grid(per_joint) > kMostSamples) --per_joint;
  const auto num_samples = static_cast<std::int64_t>(std::min<double>(grid(per_joint), 1 << 20));
  HandConfiguration configuration = open_configuration(model);
  const Eigen::VectorXd open = configuration.q;
  std::vector<TipPose> poses;
  poses.reserve(num_samples);
  for (std::int64_t sample = 0; sample < num_samples; ++sample) {
    configuration.q = open;  // a breakaway joint must not keep what an earlier sample closed
    std::int64_t rest = sample;
    for (const int joint : leaders) {
      const double share = static_cast<double>(rest % per_joint) / (per_joint - 1);
      rest /= per_joint;
      const Joint& limits = model.joints[joint];
      configuration.q[joint] = limits.lower + share * (limits.upper - limits.lower);
    }
    apply_couplings(model, configuration.q);
    // The poses are in H, the frame of the hand's base.
    const std::vector<RigidTransform> X_HL = forward_kinematics(model, configuration);
    poses.push_back({pad_contact_point(model, *finger.tip_pad, X_HL),
                     pad_pose(model, *finger.tip_pad, X_HL).linear().col(2)});
  }
  return poses;
}

}  // namespace

TipReach::TipReach(const std::vector<TipPose>& poses, double cell) : cell_(cell) {
  if (poses.empty() || !(cell > 0.0)) {
    throw base::InvalidInput("TipReach: needs poses and a cell > 0 m");
  }
  Eigen::AlignedBox3d box;
  for (const TipPose& pose : poses) box.extend(pose.point_H);
  geometry::VoxelGrid grid;
  grid.lattice.origin = box.min() - Vector3d::Constant((kBorder + 0.5) * cell);
  grid.lattice.voxel_size = cell;
  const Eigen::Array3d counts = (box.sizes() / cell).array().ceil() + 2 * kBorder + 2;
  // Written so that NaN fails.
  if (!(counts.prod() <= kMostCells)) {
    throw base::InvalidInput("TipReach: places " + base::shortest_decimal(box.sizes().maxCoeff()) +
                             " m apart are too far for cells of " + base::shortest_decimal(cell) +
                             " m: the hand's lengths are in another unit");
  }
  grid.lattice.counts = counts.cast<int>().matrix();
  std::vector<bool> is_known(grid.lattice.num_voxels(), false);
  for (const TipPose& pose : poses) {
    const Eigen::Vector3i voxel = grid.lattice.voxel_at(pose.point_H);
    const std::int64_t index = grid.lattice.index(voxel);
    if (!is_known[index]) visited_H_.push_back(grid.lattice.center(voxel));
    is_known[index] = true;
  }
  for (const Vector3d& direction : looking_directions()) {
    grid.classes.assign(grid.lattice.num_voxels(), geometry::VoxelClass::Empty);
    bool is_visited = false;
    for (const TipPose& pose : poses) {
      if (pose.normal_H.dot(direction) < kCosLooking) continue;
      const std::int64_t voxel = grid.lattice.index(grid.lattice.voxel_at(pose.point_H));
      grid.classes[voxel] = geometry::VoxelClass::Partial;
      is_visited = true;
    }
    maps_H_.emplace_back();
    if (is_visited) maps_H_.back() = geometry::signed_distance_map(grid);
  }
}

double TipReach::distance(const Vector3d& point_H, const Vector3d& normal_H) const {
  const auto& map_H = maps_H_[nearest_direction(normal_H)];
  if (!map_H) return std::numeric_limits<double>::infinity();
  return map_H->at(point_H) * map_H->lattice.voxel_size;
}

std::vector<std::optional<TipReach>> tip_reaches(const HandModel& model) {
  validate(model);
  std::vector<std::optional<TipReach>> reaches;
  for (const Finger& finger : model.fingers) {
    reaches.emplace_back();
    if (finger.tip_pad) reaches.back().emplace(tip_poses(model, finger), kCell);
  }
  return reaches;
}

}  // namespace graspfit::hands
