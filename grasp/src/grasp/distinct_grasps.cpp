#include "graspfit/grasp/distinct_grasps.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "graspfit/base/option_check.hpp"
#include "rows/range_check.hpp"

namespace graspfit::grasp {

namespace {

void require_joints(const hands::HandModel& hand, const hands::HandConfiguration& configuration) {
  base::require(configuration.q.size() == std::ssize(hand.joints),
                "distinct grasps: hand " + hand.name, "number of joint positions",
                static_cast<long>(configuration.q.size()),
                "that of its joints, " + std::to_string(hand.joints.size()));
}

/// Least angle of a rotation matrix; by `atan2`, so that small angles keep their digits.
double angle_of(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond turn(rotation);
  return 2.0 * std::atan2(turn.vec().norm(), std::abs(turn.w()));
}

}  // namespace

void DistinctOptions::validate() const {
  internal::require_ranges("DistinctOptions", *this, internal::distinct_rows);
}

ConfigurationDistance configuration_distance(const hands::HandModel& hand,
                                             const hands::HandConfiguration& a,
                                             const hands::HandConfiguration& b,
                                             double slide_scale) {
  require_joints(hand, a);
  require_joints(hand, b);
  base::require(slide_scale > 0.0 && std::isfinite(slide_scale), "configuration_distance",
                "slide_scale", slide_scale, "finite and > 0 m");
  ConfigurationDistance result;
  result.translation = (a.X_OH * hand.palm.center_H - b.X_OH * hand.palm.center_H).norm();
  result.rotation = angle_of(a.X_OH.linear().transpose() * b.X_OH.linear());
  for (int j = 0; j < std::ssize(hand.joints); ++j) {
    const hands::Joint& joint = hand.joints[j];
    if (joint.coupling) continue;
    const double difference = std::abs(a.q[j] - b.q[j]);
    result.joints =
        std::max(result.joints,
                 joint.type == hands::JointType::Prismatic ? difference / slide_scale : difference);
  }
  return result;
}

bool are_distinct(const hands::HandModel& hand, const hands::HandConfiguration& a,
                  const hands::HandConfiguration& b, const DistinctOptions& options) {
  options.validate();
  const ConfigurationDistance distance = configuration_distance(hand, a, b, options.slide_scale);
  return distance.translation > options.translation || distance.rotation > options.rotation ||
         distance.joints > options.joints;
}

std::vector<std::size_t> distinct_subset(const hands::HandModel& hand,
                                         std::span<const hands::HandConfiguration> best_first,
                                         const DistinctOptions& options) {
  options.validate();
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < best_first.size(); ++i) {
    require_joints(hand, best_first[i]);
    const bool is_new = std::all_of(kept.begin(), kept.end(), [&](std::size_t before) {
      return are_distinct(hand, best_first[before], best_first[i], options);
    });
    if (is_new) kept.push_back(i);
  }
  return kept;
}

}  // namespace graspfit::grasp
