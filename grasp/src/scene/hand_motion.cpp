#include "scene/hand_motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/jacobian.hpp"
#include "graspfit/hands/kinematic_chain.hpp"

namespace graspfit::grasp::internal {

using Eigen::Index;
using Eigen::RowVectorXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using hands::RigidTransform;

MotionEntries::MotionEntries(const hands::HandModel& hand, bool palm_translates, bool palm_turns,
                             Breakaway breakaway)
    : hand_(hand),
      palm_translates_(palm_translates),
      palm_turns_(palm_turns),
      breakaway_(breakaway) {
  constexpr double kShortestLever = 0.02;  // [m]; a shorter one would let a joint spin
  entry_of_joint_.assign(hand.joints.size(), 0);
  lever_.assign(hand.joints.size(), 1.0);
  const hands::HandConfiguration open = hands::open_configuration(hand);
  open_q_ = open.q;
  const std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, open);
  for (int link = 0; link < std::ssize(hand.links); ++link) {
    joints_above_.push_back(hands::joints_to(hand, link));
    std::reverse(joints_above_.back().begin(), joints_above_.back().end());
  }
  for (int j = 0; j < std::ssize(hand.joints); ++j) {
    const hands::Joint& joint = hand.joints[j];
    if (joint.type == hands::JointType::Revolute) {
      const Vector3d origin = X_OL[joint.child_link].translation();
      double reach = kShortestLever;
      for (const int link : hands::links_moved_by(hand, j)) {
        for (const Vector3d& vertex : hand.links[link].mesh_L.vertices) {
          reach = std::max(reach, (X_OL[link] * vertex - origin).norm());
        }
      }
      lever_[j] = reach;
    }
    if (!joint.coupling || joint.coupling->breakaway) {
      entry_of_joint_[j] = base::as_index<int>(6 + free_joints_.size());
      free_joints_.push_back(j);
    }
  }
  for (int j = 0; j < std::ssize(hand.joints); ++j) {
    const hands::Joint& joint = hand.joints[j];
    if (!joint.coupling || joint.coupling->breakaway) continue;
    entry_of_joint_[j] = entry_of_joint_[joint.coupling->leader];
  }
}

/// Whether the entry of a joint is what it moves beyond its coupling.
bool MotionEntries::is_beyond(int j) const {
  const std::optional<hands::Coupling>& coupling = hand_.joints[j].coupling;
  return breakaway_ == Breakaway::Beyond && coupling && coupling->breakaway;
}

HandMotion::HandMotion(const MotionEntries& entries, const hands::HandConfiguration& configuration,
                       const std::vector<RigidTransform>& X_OL, const Vector3d& pivot_O)
    : entries_(entries),
      hand_(entries.hand_),
      configuration_(configuration),
      X_OL_(X_OL),
      pivot_O_(pivot_O) {}

/// Ratio by which a joint moves with its entry of the motion; 0 where the joint's own limit holds
/// it back.
double HandMotion::share_of_entry(int j) const {
  const hands::Joint& joint = hand_.joints[j];
  if (joint.coupling && joint.coupling->breakaway) return 1.0;
  return hands::ratio_to_leader(hand_, j, configuration_.q, hands::Followers::WithinLimits);
}

template <class Rate>
RowVectorXd HandMotion::with_joints(RowVectorXd row, int link, const Vector3d& point_O,
                                    const Rate& rate) const {
  for (const int j : entries_.joints_above_[link]) {
    const hands::Joint& joint = hand_.joints[j];
    const hands::JointVelocity velocity =
        hands::joint_velocity(joint, X_OL_[joint.child_link], point_O);
    const int entry = entries_.entry_of_joint_[j];
    const int driver = entries_.free_joints_[entry - 6];
    row[entry] += share_of_entry(j) * rate(velocity) / entries_.lever_[driver];
    if (!entries_.is_beyond(j)) continue;
    const int leader = joint.coupling->leader;
    row[entries_.entry_of_joint_[leader]] +=
        joint.coupling->ratio * rate(velocity) / entries_.lever_[leader];
  }
  return row;
}

RowVectorXd HandMotion::row(int link, const Vector3d& point_O, const Vector3d& direction_O) const {
  RowVectorXd of_palm = RowVectorXd::Zero(size());
  if (entries_.palm_translates_) of_palm.head<3>() = direction_O.transpose();
  if (entries_.palm_turns_) {
    of_palm.segment<3>(3) = (point_O - pivot_O_).cross(direction_O).transpose() / kTurnLever;
  }
  return with_joints(std::move(of_palm), link, point_O, [&](const hands::JointVelocity& velocity) {
    return velocity.linear.dot(direction_O);
  });
}

RowVectorXd HandMotion::turn_row(int link, const Vector3d& axis) const {
  RowVectorXd of_palm = RowVectorXd::Zero(size());
  if (entries_.palm_turns_) of_palm.segment<3>(3) = axis.transpose() / kTurnLever;
  return with_joints(std::move(of_palm), link, pivot_O_, [&](const hands::JointVelocity& velocity) {
    return velocity.angular.dot(axis);
  });
}

HandMotion::Bounds HandMotion::bounds(double trust) const {
  Bounds bounds{VectorXd::Constant(size(), -trust), VectorXd::Constant(size(), trust)};
  for (Index k = 0; k < std::ssize(entries_.free_joints_); ++k) {
    const int j = entries_.free_joints_[k];
    const hands::Joint& joint = hand_.joints[j];
    const double q = configuration_.q[j];
    const Index entry = 6 + k;
    bounds.lower[entry] = std::max(-trust, std::min(0.0, (joint.lower - q) * entries_.lever_[j]));
    bounds.upper[entry] = std::min(trust, std::max(0.0, (joint.upper - q) * entries_.lever_[j]));
    if (!entries_.is_beyond(j)) continue;
    const double back =
        (hands::followed_position(joint, configuration_.q) - q) * entries_.lever_[j];
    double& least = joint.closing_sign > 0 ? bounds.lower[entry] : bounds.upper[entry];
    least = joint.closing_sign > 0 ? std::max(least, std::min(0.0, back))
                                   : std::min(least, std::max(0.0, back));
  }
  return bounds;
}

std::vector<HandMotion::Limit> HandMotion::breakaway_rows() const {
  std::vector<Limit> limits;
  for (int j = 0; j < std::ssize(hand_.joints); ++j) {
    const hands::Joint& joint = hand_.joints[j];
    if (!joint.coupling || !joint.coupling->breakaway) continue;
    const int leader = joint.coupling->leader;
    const double sign = joint.closing_sign;
    const double follows = hands::followed_position(joint, configuration_.q);
    const double beyond = sign * (configuration_.q[j] - follows);
    RowVectorXd row = RowVectorXd::Zero(size());
    row[entries_.entry_of_joint_[j]] += sign / entries_.lever_[j];
    row[entries_.entry_of_joint_[leader]] -= sign * joint.coupling->ratio / entries_.lever_[leader];
    limits.push_back({row * entries_.lever_[j], -std::max(0.0, beyond) * entries_.lever_[j]});
  }
  return limits;
}

VectorXd HandMotion::opening(int link, double step) const {
  VectorXd motion = VectorXd::Zero(size());
  for (const int j : entries_.joints_above_[link]) {
    const hands::Joint& joint = hand_.joints[j];
    const bool is_against_entry =
        joint.coupling && !joint.coupling->breakaway && joint.coupling->ratio < 0.0;
    const double sign = -joint.closing_sign * (is_against_entry ? -1.0 : 1.0);
    if (sign != 0.0) motion[entries_.entry_of_joint_[j]] = sign * step;
  }
  const auto [lower, upper] = bounds(step);
  return motion.cwiseMax(lower).cwiseMin(upper);
}

VectorXd HandMotion::straightening(int link, double step) const {
  VectorXd motion = VectorXd::Zero(size());
  for (const int j : entries_.joints_above_[link]) {
    if (hand_.joints[j].closing_sign != 0) continue;
    const int entry = entries_.entry_of_joint_[j];
    const int joint = entries_.free_joints_[entry - 6];
    const double way = entries_.open_q_[joint] - configuration_.q[joint];
    motion[entry] = std::clamp(way * entries_.lever_[joint], -step, step);
  }
  return motion;
}

hands::HandConfiguration HandMotion::moved(const VectorXd& motion) const {
  hands::HandConfiguration result = configuration_;
  if (entries_.palm_turns_) {
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
  if (entries_.palm_translates_) result.X_OH.translation() += motion.head<3>();
  for (Index k = 0; k < std::ssize(entries_.free_joints_); ++k) {
    const int j = entries_.free_joints_[k];
    result.q[j] += motion[6 + k] / entries_.lever_[j];
  }
  for (std::size_t k = 0; k < entries_.free_joints_.size(); ++k) {
    const int j = entries_.free_joints_[k];
    if (!entries_.is_beyond(j)) continue;
    const hands::Coupling& coupling = *hand_.joints[j].coupling;
    result.q[j] +=
        hands::led_position(coupling, result.q) - hands::led_position(coupling, configuration_.q);
  }
  hands::clamp_to_limits(hand_, result.q);
  hands::apply_couplings(hand_, result.q);
  return result;
}

}  // namespace graspfit::grasp::internal
