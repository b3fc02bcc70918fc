#include "scene/hand_motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/jacobian.hpp"
#include "graspfit/hands/kinematic_chain.hpp"

namespace graspfit::grasp::internal {

using Eigen::Index;
using Eigen::RowVectorXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using hands::RigidTransform;

HandMotion::HandMotion(const hands::HandModel& hand, bool palm_translates, bool palm_turns,
                       Breakaway breakaway)
    : hand_(hand),
      palm_translates_(palm_translates),
      palm_turns_(palm_turns),
      breakaway_(breakaway) {
  constexpr double kShortestLever = 0.02;  // [m]; a shorter one would let a joint spin
  const auto num_joints = hand.joints.size();
  entry_of_joint_.assign(num_joints, 0);
  ratio_.assign(num_joints, 1.0);
  lever_.assign(num_joints, 1.0);
  const hands::HandConfiguration open = hands::open_configuration(hand);
  open_q_ = open.q;
  const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, open);
  for (std::size_t link = 0; link < hand.links.size(); ++link) {
    joints_above_.push_back(hands::joints_to(hand, static_cast<int>(link)));
    std::reverse(joints_above_.back().begin(), joints_above_.back().end());
  }
  for (std::size_t j = 0; j < num_joints; ++j) {
    const hands::Joint& joint = hand.joints[j];
    if (joint.type == hands::JointType::Revolute) {
      const Vector3d origin = X_OL[joint.child_link].translation();
      double reach = kShortestLever;
      for (const int link : hands::links_moved_by(hand, static_cast<int>(j))) {
        const auto index = static_cast<std::size_t>(link);
        for (const Vector3d& vertex : hand.links[index].mesh_L.vertices) {
          reach = std::max(reach, (X_OL[index] * vertex - origin).norm());
        }
      }
      lever_[j] = reach;
    }
    if (!joint.coupling || joint.coupling->breakaway) {
      entry_of_joint_[j] = 6 + static_cast<int>(free_joints_.size());
      free_joints_.push_back(static_cast<int>(j));
    }
  }
  for (std::size_t j = 0; j < num_joints; ++j) {
    const hands::Joint& joint = hand.joints[j];
    if (!joint.coupling || joint.coupling->breakaway) continue;
    entry_of_joint_[j] = entry_of_joint_[joint.coupling->leader];
    ratio_[j] = joint.coupling->ratio;
  }
}

void HandMotion::set(const hands::HandConfiguration& configuration,
                     const std::vector<RigidTransform>& X_OL, const Vector3d& pivot_O) {
  configuration_ = configuration;
  X_OL_ = X_OL;
  pivot_O_ = pivot_O;
}

/// Whether the entry of a joint is what it moves beyond its coupling.
bool HandMotion::is_beyond(int j) const {
  const std::optional<hands::Coupling>& coupling = hand_.joints[j].coupling;
  return breakaway_ == Breakaway::Beyond && coupling && coupling->breakaway;
}

/// Ratio by which a joint moves with its entry of the motion; 0 where the joint's own limit holds
/// it back.
double HandMotion::share_of_follower(int j) const {
  const auto index = static_cast<std::size_t>(j);
  const hands::Joint& joint = hand_.joints[index];
  if (!joint.coupling || joint.coupling->breakaway) return 1.0;
  const double follows = hands::led_position(*joint.coupling, configuration_.q);
  return follows < joint.lower || follows > joint.upper ? 0.0 : ratio_[index];
}

template <class Rate>
void HandMotion::add_joints(int link, const Vector3d& point_O, const Rate& rate,
                            RowVectorXd& row) const {
  for (const int j : joints_above_[link]) {
    const hands::Joint& joint = hand_.joints[j];
    const hands::JointVelocity velocity =
        hands::joint_velocity(joint, X_OL_[joint.child_link], point_O);
    const int entry = entry_of_joint_[j];
    const auto leader = static_cast<std::size_t>(free_joints_[entry - 6]);
    row[entry] += share_of_follower(j) * rate(velocity) / lever_[leader];
    if (!is_beyond(j)) continue;
    const int followed = joint.coupling->leader;
    const int its_entry = entry_of_joint_[followed];
    row[its_entry] += joint.coupling->ratio * share_of_follower(followed) * rate(velocity) /
                      lever_[free_joints_[its_entry - 6]];
  }
}

RowVectorXd HandMotion::row(int link, const Vector3d& point_O, const Vector3d& direction_O) const {
  RowVectorXd result = RowVectorXd::Zero(size());
  if (palm_translates_) result.head<3>() = direction_O.transpose();
  if (palm_turns_) {
    result.segment<3>(3) = (point_O - pivot_O_).cross(direction_O).transpose() / kTurnLever;
  }
  add_joints(
      link, point_O,
      [&](const hands::JointVelocity& velocity) { return velocity.linear.dot(direction_O); },
      result);
  return result;
}

RowVectorXd HandMotion::turn_row(int link, const Vector3d& axis) const {
  RowVectorXd result = RowVectorXd::Zero(size());
  if (palm_turns_) result.segment<3>(3) = axis.transpose() / kTurnLever;
  add_joints(
      link, pivot_O_,
      [&](const hands::JointVelocity& velocity) { return velocity.angular.dot(axis); }, result);
  return result;
}

HandMotion::Bounds HandMotion::bounds(double trust) const {
  Bounds bounds{VectorXd::Constant(size(), -trust), VectorXd::Constant(size(), trust)};
  for (std::size_t k = 0; k < free_joints_.size(); ++k) {
    const auto j = static_cast<std::size_t>(free_joints_[k]);
    const hands::Joint& joint = hand_.joints[j];
    const double q = configuration_.q[free_joints_[k]];
    const auto entry = static_cast<Index>(6 + k);
    bounds.lower[entry] = std::max(-trust, std::min(0.0, (joint.lower - q) * lever_[j]));
    bounds.upper[entry] = std::min(trust, std::max(0.0, (joint.upper - q) * lever_[j]));
    if (!is_beyond(free_joints_[k])) continue;
    const double back = (hands::followed_position(joint, configuration_.q) - q) * lever_[j];
    double& least = joint.closing_sign > 0 ? bounds.lower[entry] : bounds.upper[entry];
    least = joint.closing_sign > 0 ? std::max(least, std::min(0.0, back))
                                   : std::min(least, std::max(0.0, back));
  }
  return bounds;
}

std::vector<HandMotion::Limit> HandMotion::breakaway_rows() const {
  std::vector<Limit> limits;
  for (std::size_t j = 0; j < hand_.joints.size(); ++j) {
    const hands::Joint& joint = hand_.joints[j];
    if (!joint.coupling || !joint.coupling->breakaway) continue;
    const auto leader = static_cast<std::size_t>(joint.coupling->leader);
    const double sign = joint.closing_sign;
    const double follows = hands::followed_position(joint, configuration_.q);
    const double beyond = sign * (configuration_.q[static_cast<Index>(j)] - follows);
    RowVectorXd row = RowVectorXd::Zero(size());
    row[entry_of_joint_[j]] += sign / lever_[j];
    row[entry_of_joint_[leader]] -= sign * joint.coupling->ratio * ratio_[leader] / lever_[leader];
    limits.push_back({row * lever_[j], -std::max(0.0, beyond) * lever_[j]});
  }
  return limits;
}

VectorXd HandMotion::opening(int link, double step) const {
  VectorXd motion = VectorXd::Zero(size());
  for (const int j : joints_above_[link]) {
    const auto index = static_cast<std::size_t>(j);
    const hands::Joint& joint = hand_.joints[index];
    const double sign = -joint.closing_sign * (ratio_[index] < 0.0 ? -1.0 : 1.0);
    if (sign != 0.0) motion[entry_of_joint_[index]] = sign * step;
  }
  const auto [lower, upper] = bounds(step);
  return motion.cwiseMax(lower).cwiseMin(upper);
}

VectorXd HandMotion::straightening(int link, double step) const {
  VectorXd motion = VectorXd::Zero(size());
  for (const int j : joints_above_[link]) {
    if (hand_.joints[j].closing_sign != 0) continue;
    const int entry = entry_of_joint_[j];
    const int joint = free_joints_[entry - 6];
    const double way = open_q_[joint] - configuration_.q[joint];
    motion[entry] = std::clamp(way * lever_[joint], -step, step);
  }
  return motion;
}

hands::HandConfiguration HandMotion::moved(const VectorXd& motion) const {
  hands::HandConfiguration result = configuration_;
  if (palm_turns_) {
    const Vector3d turn = motion.segment<3>(3) / kTurnLever;
    const double angle = turn.norm();
    if (angle > 0.0) {
      const Eigen::AngleAxisd rotation(angle, turn / angle);
      Eigen::Quaterniond orientation(rotation * configuration_.X_OH.linear());
      orientation.normalize();
      result.X_OH.linear() = orientation.toRotationMatrix();
      result.X_OH.translation() =
          pivot_O_ + rotation * Vector3d(configuration_.X_OH.translation() - pivot_O_);
    }
  }
  if (palm_translates_) result.X_OH.translation() += motion.head<3>();
  for (std::size_t k = 0; k < free_joints_.size(); ++k) {
    result.q[free_joints_[k]] += motion[static_cast<Index>(6 + k)] / lever_[free_joints_[k]];
  }
  for (std::size_t k = 0; k < free_joints_.size(); ++k) {
    const int j = free_joints_[k];
    if (!is_beyond(j)) continue;
    const hands::Coupling& coupling = *hand_.joints[j].coupling;
    result.q[j] +=
        hands::led_position(coupling, result.q) - hands::led_position(coupling, configuration_.q);
  }
  hands::clamp_to_limits(hand_, result.q);
  hands::apply_couplings(hand_, result.q);
  return result;
}

}  // namespace graspfit::grasp::internal
