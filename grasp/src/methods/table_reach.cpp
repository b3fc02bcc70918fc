#include "methods/table_reach.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "graspfit/hands/contact_pad.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/kinematic_chain.hpp"

namespace graspfit::grasp::internal {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

constexpr double kMostBelow = 0.005;  // of a proposal's links, which are laid later [m]
constexpr int kAngles = 46;           // of a normal against up, over half a turn
constexpr int kLeanSteps = 8;         // of these angles: 30 degrees or so
constexpr int kTurns = 24;            // about the normal
constexpr double kMostLever = 0.12;   // beyond the least one [m]

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

/// Of the points those that lie outermost in one of 26 directions, each once.
std::vector<Vector3d> outermost(const std::vector<Vector3d>& points) {
  std::set<std::size_t> found;
  for (int x = -1; x <= 1 && !points.empty(); ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const Vector3d direction(x, y, z);
        const auto last = std::max_element(points.begin(), points.end(),
                                           [&](const Vector3d& a, const Vector3d& b) {
                                             return direction.dot(a) < direction.dot(b);
                                           });
        found.insert(static_cast<std::size_t>(last - points.begin()));
      }
    }
  }
  std::vector<Vector3d> result;
  for (const std::size_t i : found) result.push_back(points[i]);
  return result;
}

}  // namespace

TableReach::TableReach(const hands::HandModel& hand, const SurroundingsCollision& surroundings,
                       const std::vector<const hands::PadSamples*>& samples)
    : surroundings_(surroundings) {
  if (!has_table()) return;
  std::vector<std::vector<Vector3d>> corners_L;
  for (int link = 0; link < std::ssize(hand.links); ++link) {
    corners_L.push_back(outermost(surroundings.corners_L(link)));
  }
  const auto poses = [&](hands::HandConfiguration configuration) {
    hands::apply_couplings(hand, configuration.q);
    return hands::forward_kinematics(hand, configuration);
  };
  hands::HandConfiguration configuration = hands::open_configuration(hand);
  configuration.X_OH = geometry::RigidTransform::Identity();
  std::vector<Vector3d> points_H;
  const auto add = [&](int link, const std::vector<geometry::RigidTransform>& X_HL) {
    for (const Vector3d& corner : corners_L[link]) points_H.push_back(X_HL[link] * corner);
  };
  const auto taken = [&] {
    Eigen::Matrix3Xd columns(3, std::ssize(points_H));
    for (Index i = 0; i < columns.cols(); ++i) columns.col(i) = points_H[i];
    points_H.clear();
    return columns;
  };
  const std::vector<geometry::RigidTransform> X_HL_open = poses(configuration);
  const auto is_fixed_to_palm = [&](int link) { return hands::joints_to(hand, link).empty(); };
  for (int link = 0; link < std::ssize(hand.links); ++link) {
    if (is_fixed_to_palm(link)) add(link, X_HL_open);
  }
  palm_H_ = taken();
  for (const hands::PadSamples* of_pad : samples) {
    std::vector<int> links = hands::links_to(hand, hand.pads[of_pad->pad].link);
    std::erase_if(links, is_fixed_to_palm);
    Corners& corners = corners_.emplace_back();
    for (Index sample = 0; sample < of_pad->points_H.cols(); ++sample) {
      for (int j = 0; j < std::ssize(of_pad->joints); ++j) {
        configuration.q[of_pad->joints[j]] = of_pad->positions(j, sample);
      }
      const std::vector<geometry::RigidTransform> X_HL = poses(configuration);
      for (const int link : links) add(link, X_HL);
      if (sample == 0) corners.per_sample = std::ssize(points_H);
    }
    corners.points_H = taken();
  }
}

template <class Columns>
bool TableReach::are_above(const Columns& points_H, const geometry::RigidTransform& X_OH) const {
  const Surroundings& around = surroundings_.surroundings();
  const double least =
      *around.table_z_O + around.table_clearance - kMostBelow - X_OH.translation().z();
  const Vector3d up_H = X_OH.linear().row(2);
  for (Index i = 0; i < points_H.cols(); ++i) {
    if (up_H.dot(points_H.col(i)) < least) return false;
  }
  return true;
}

bool TableReach::is_palm_above(const geometry::RigidTransform& X_OH) const {
  return !has_table() || are_above(palm_H_, X_OH);
}

bool TableReach::is_above(std::size_t samples, std::int32_t sample,
                          const geometry::RigidTransform& X_OH) const {
  if (!has_table()) return true;
  const Corners& corners = corners_[samples];
  return are_above(corners.points_H.middleCols(sample * corners.per_sample, corners.per_sample),
                   X_OH);
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

std::vector<PoolPoint> carrying_above_table(std::vector<PoolPoint> pool,
                                            const Vector3d& center_of_mass_O,
                                            const SurroundingsCollision& surroundings) {
  if (!surroundings.surroundings().table_z_O || pool.empty()) return pool;
  const auto lever = [&](const PoolPoint& point) {
    return (point.point_O - center_of_mass_O).head<2>().norm();
  };
  double least = std::numeric_limits<double>::infinity();
  for (const PoolPoint& point : pool) least = std::min(least, lever(point));
  std::erase_if(pool, [&](const PoolPoint& point) { return lever(point) > least + kMostLever; });
  return pool;
}

}  // namespace graspfit::grasp::internal
