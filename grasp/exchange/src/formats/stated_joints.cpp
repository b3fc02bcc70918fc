#include "formats/stated_joints.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "graspfit/base/list_text.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::exchange::internal {

using base::shortest_decimal;

StatedJoints::StatedJoints(const hands::HandModel& hand)
    : hand_(hand),
      q_(Eigen::VectorXd::Constant(std::ssize(hand.joints),
                                   std::numeric_limits<double>::quiet_NaN())) {}

std::optional<Eigen::Index> StatedJoints::index_of(const std::string& name) const {
  const auto found = std::find_if(hand_.joints.begin(), hand_.joints.end(),
                                  [&](const hands::Joint& joint) { return joint.name == name; });
  if (found == hand_.joints.end()) return std::nullopt;
  return found - hand_.joints.begin();
}

std::string StatedJoints::unknown_text() const {
  return "hand " + hand_.name + " has no such joint; it has " +
         base::list_text(hand_.joints, &hands::Joint::name);
}

std::optional<std::string> StatedJoints::state(Eigen::Index joint, double position,
                                               const ImportTolerances& tolerances) {
  const hands::Joint& stated = hand_.joints[static_cast<std::size_t>(joint)];
  const double excess = std::max(stated.lower - position, position - stated.upper);
  if (!(excess <= tolerances.largest_limit_excess)) {
    return "is " + shortest_decimal(position) + ", outside the joint's " +
           shortest_decimal(stated.lower) + " to " + shortest_decimal(stated.upper);
  }
  q_[joint] = std::clamp(position, stated.lower, stated.upper);
  return std::nullopt;
}

std::optional<std::string> StatedJoints::complete(const ImportTolerances& tolerances) {
  const Eigen::VectorXd stated = q_;
  for (int j = 0; j < std::ssize(hand_.joints); ++j) {
    const hands::Joint& joint = hand_.joints[j];
    if (!std::isnan(q_[j])) continue;
    if (!joint.coupling) return "joint " + joint.name + " of hand " + hand_.name + " is missing";
    // Any position will do for a follower: the couplings correct all but those that a clutch lets
    // go on closing.
    q_[j] = joint.open_limit();
  }
  hands::apply_couplings(hand_, q_);
  for (int j = 0; j < std::ssize(hand_.joints); ++j) {
    if (std::isnan(stated[j]) || std::abs(stated[j] - q_[j]) <= tolerances.largest_coupling_error) {
      continue;
    }
    const hands::Joint& joint = hand_.joints[j];
    return "joint " + joint.name + " is " + shortest_decimal(stated[j]) + ", but its leader " +
           hand_.joints[joint.coupling->leader].name + " puts it at " + shortest_decimal(q_[j]);
  }
  return std::nullopt;
}

}  // namespace graspfit::exchange::internal
