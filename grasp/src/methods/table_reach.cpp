#include "methods/table_reach.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "graspfit/hands/contact_pad.hpp"
#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::grasp::internal {
namespace {

using Eigen::Vector3d;

constexpr double kMostBelow = 0.005;  // of a proposal's links, which are laid later [m]
constexpr int kAngles = 46;           // of a normal against up, over half a turn
constexpr int kLeanSteps = 8;         // of these angles: 30 degrees or so
constexpr int kTurns = 24;            // about the normal

/// Per angle between up and the direction in which pads press: how far below where it touches the
/// link of that pad reaches that reaches least far [m].
std::array<double, kAngles> depths_below(const hands::HandModel& hand,
                                         const SurroundingsCollision& surroundings) {
  std::array<double, kAngles> upright;
  upright.fill(std::numeric_limits<double>::infinity());
  for (const hands::ContactPad& pad : hand.pads) {
    const geometry::RigidTransform X_CL = geometry::inverted(pad.X_LC);
    const Vector3d middle = hands::pad_contact_point_C(pad);
    const Vector3d to_end = hands::pad_point_toward_end_C(pad, 1.0) - middle;
    std::vector<Vector3d> points;
    for (const Vector3d& corner_L : surroundings.corners_L(pad.link)) {
      points.push_back(X_CL * corner_L - middle);
    }
    for (int i = 0; i < kAngles; ++i) {
      const double angle = std::numbers::pi * i / (kAngles - 1);
      for (int turn = 0; turn < kTurns; ++turn) {
        const double around = 2.0 * std::numbers::pi * turn / kTurns;
        const Vector3d up(std::sin(angle) * std::cos(around), std::sin(angle) * std::sin(around),
                          std::cos(angle));
        double depth = 0.0;
        for (const Vector3d& point : points) depth = std::max(depth, -up.dot(point));
        // It may touch by the middle, by the end or between.
        upright[i] = std::min({upright[i], depth, std::max(0.0, depth + up.dot(to_end))});
      }
    }
  }
  std::array<double, kAngles> depths{};
  for (int i = 0; i < kAngles; ++i) {
    const auto first = upright.begin() + std::max(0, i - kLeanSteps);
    const auto last = upright.begin() + std::min(kAngles, i + kLeanSteps + 1);
    depths[i] = *std::min_element(first, last);
  }
  return depths;
}

}  // namespace

TableReach::TableReach(const hands::HandModel& hand, const SurroundingsCollision& surroundings)
    : hand_(hand), surroundings_(surroundings) {
  for (int link = 0; link < std::ssize(hand.links); ++link) {
    std::vector<int>& joints = joints_.emplace_back();
    for (std::optional<int> at = link; at; at = hand.links[*at].parent_link) {
      if (const auto& joint = hand.links[*at].parent_joint) joints.push_back(*joint);
    }
  }
}

bool TableReach::is_above(hands::HandConfiguration configuration,
                          const std::vector<bool>& is_fixed) const {
  if (!has_table()) return true;
  hands::apply_couplings(hand_, configuration.q);
  const auto is_settled = [&](int joint) {
    const auto& coupling = hand_.joints[joint].coupling;
    return is_fixed[joint] || (coupling && is_fixed[coupling->leader]);
  };
  const std::vector<geometry::RigidTransform> X_OL =
      hands::forward_kinematics(hand_, configuration);
  for (int link = 0; link < std::ssize(X_OL); ++link) {
    if (!std::all_of(joints_[link].begin(), joints_[link].end(), is_settled)) continue;
    const auto lowest = surroundings_.over_table(link, X_OL[link], -kMostBelow);
    if (lowest && lowest->height < -kMostBelow) return false;
  }
  return true;
}

std::vector<PoolPoint> touchable_above_table(std::vector<PoolPoint> pool,
                                             const hands::HandModel& hand,
                                             const SurroundingsCollision& surroundings) {
  const Surroundings& around = surroundings.surroundings();
  if (!around.table_z_O) return pool;
  const double floor = *around.table_z_O + around.table_clearance;
  const std::array<double, kAngles> depths = depths_below(hand, surroundings);
  std::erase_if(pool, [&](const PoolPoint& point) {
    const double angle = std::acos(std::clamp(point.inward_normal_O.z(), -1.0, 1.0));
    const auto i = static_cast<std::size_t>(std::lround(angle / std::numbers::pi * (kAngles - 1)));
    return point.point_O.z() - floor < depths[i];
  });
  return pool;
}

}  // namespace graspfit::grasp::internal
