#include "graspfit/hands/tip_reach.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "graspfit/geometry/errors.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::hands {
namespace {

using Eigen::Vector3d;

constexpr double kCell = 0.006;  // [m] finer than any fingertip is wide
constexpr int kMostSamples = 1 << 14;
constexpr int kMostPerJoint = 128;

/// The independent joints that move a finger, ascending.
std::vector<int> leaders_of(const HandModel& model, const Finger& finger) {
  std::vector<int> leaders;
  for (const int joint : finger.joints) {
    const auto& coupling = model.joints[joint].coupling;
    leaders.push_back(coupling ? coupling->leader : joint);
  }
  std::sort(leaders.begin(), leaders.end());
  leaders.erase(std::unique(leaders.begin(), leaders.end()), leaders.end());
  return leaders;
}

std::vector<Vector3d> tip_points(const HandModel& model, const Finger& finger) {
  const std::vector<int> leaders = leaders_of(model, finger);
  int per_joint = kMostPerJoint;
  const auto grid = [&](int n) { return std::pow(n, static_cast<double>(leaders.size())); };
  while (per_joint > 2 && grid(per_joint) > kMostSamples) --per_joint;
  const auto num_samples = static_cast<std::int64_t>(std::min<double>(grid(per_joint), 1 << 20));
  HandConfiguration configuration = open_configuration(model);
  const Eigen::VectorXd open = configuration.q;
  std::vector<Vector3d> points;
  points.reserve(static_cast<std::size_t>(num_samples));
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
    points.push_back(
        pad_contact_point(model, finger.tip_pad, forward_kinematics(model, configuration)));
  }
  return points;
}

}  // namespace

TipReach::TipReach(const std::vector<Vector3d>& points_H, double cell) {
  if (points_H.empty() || !(cell > 0.0)) {
    throw geometry::InvalidInput("TipReach: needs points and a cell > 0 m");
  }
  for (const Vector3d& point : points_H) box_H_.extend(point);
  geometry::VoxelGrid grid;
  // One cell of room on every side, so that no point is on the lattice's border.
  grid.lattice.origin = box_H_.min() - Vector3d::Constant(cell);
  grid.lattice.voxel_size = cell;
  grid.lattice.counts = (box_H_.sizes() / cell).array().ceil().cast<int>() + 3;
  grid.classes.assign(static_cast<std::size_t>(grid.lattice.num_voxels()),
                      geometry::VoxelClass::Empty);
  for (const Vector3d& point : points_H) {
    grid.classes[static_cast<std::size_t>(grid.lattice.index(grid.lattice.voxel_at(point)))] =
        geometry::VoxelClass::Partial;
  }
  map_H_ = geometry::signed_distance_map(grid);
}

double TipReach::distance(const Vector3d& point_H) const {
  return map_H_.at(point_H) * map_H_.lattice.voxel_size;
}

std::vector<std::optional<TipReach>> tip_reaches(const HandModel& model) {
  validate(model);
  std::vector<std::optional<TipReach>> reaches;
  for (const Finger& finger : model.fingers) {
    reaches.emplace_back();
    if (finger.tip_pad >= 0) reaches.back().emplace(tip_points(model, finger), kCell);
  }
  return reaches;
}

}  // namespace graspfit::hands
