#include "graspfit/hands/palm_pose.hpp"

#include <cmath>

#include "graspfit/geometry/angle.hpp"
#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::hands {
namespace {

using Eigen::Vector3d;

/// Fingertip pads' contact points of the hand half closed, in H.
std::vector<Vector3d> half_closed_tips_H(const HandModel& hand) {
  const auto X_HL = forward_kinematics(hand, closed_configuration(hand, 0.5));
  std::vector<Vector3d> tips;
  for (const Finger& finger : hand.fingers) {
    tips.push_back(finger.tip_pad ? pad_contact_point(hand, *finger.tip_pad, X_HL)
                                  : hand.palm.center_H);
  }
  return tips;
}

}  // namespace

Vector3d any_normal(const Vector3d& direction) {
  Eigen::Index least = 0;
  direction.cwiseAbs().minCoeff(&least);
  return direction.cross(Vector3d::Unit(least)).normalized();
}

Vector3d turned_axis(const Vector3d& axis, const Vector3d& direction, double angle) {
  return std::cos(angle) * axis + std::sin(angle) * direction.cross(axis);
}

Vector3d closing_axis_H(const HandModel& hand) {
  const std::vector<Vector3d> tips = half_closed_tips_H(hand);
  const int thumb = hand.thumb();
  Vector3d others = Vector3d::Zero();
  double count = 0.0;
  for (int finger = 0; finger < std::ssize(tips); ++finger) {
    if (finger == thumb) continue;
    others += tips[finger];
    count += 1.0;
  }
  const Vector3d& direction = hand.palm.direction_H;
  if (count == 0.0) return any_normal(direction);
  const Vector3d across = others / count - tips[thumb];
  const Vector3d axis = direction.cross(across);
  constexpr double kLeastAcross = 1e-6;  // [m]
  return axis.norm() < kLeastAcross ? any_normal(direction) : axis.normalized();
}

Vector3d grasp_center_H(const HandModel& hand) {
  const std::vector<Vector3d> tips = half_closed_tips_H(hand);
  double height = 0.0;
  for (const Vector3d& tip : tips) height += (tip - hand.palm.center_H).dot(hand.palm.direction_H);
  if (!tips.empty()) height /= static_cast<double>(tips.size());
  return hand.palm.center_H + 0.5 * height * hand.palm.direction_H;
}

geometry::RigidTransform palm_pose(const HandModel& hand, const Vector3d& axis_H,
                                   const Vector3d& point_H, const Vector3d& direction_O,
                                   const Vector3d& axis_O, const Vector3d& point_O) {
  Eigen::Matrix3d from_H, to_O;
  from_H << axis_H, hand.palm.direction_H.cross(axis_H), hand.palm.direction_H;
  to_O << axis_O, direction_O.cross(axis_O), direction_O;
  geometry::RigidTransform X_OH = geometry::RigidTransform::Identity();
  X_OH.linear() = to_O * from_H.transpose();
  X_OH.translation() = point_O - X_OH.linear() * point_H;
  return X_OH;
}

double angle_from_approach(const Vector3d& direction_O, const std::optional<Vector3d>& approach_O) {
  if (!approach_O) return 0.0;
  return geometry::angle_between(direction_O, *approach_O);
}

hands::HandConfiguration open_hand_spread_by(const HandModel& hand, double share) {
  HandConfiguration open = open_configuration(hand);
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    const Joint& joint = hand.joints[j];
    if (joint.closing_sign != 0 || joint.coupling) continue;
    open.q[j] = joint.lower + share * (joint.upper - joint.lower);
  }
  apply_couplings(hand, open.q);
  return open;
}

}  // namespace graspfit::hands
