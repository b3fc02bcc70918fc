#include "fitting/finger_alignment.hpp"

#include <algorithm>
#include <numbers>

#include "fitting/finger_swing.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/kinematic_chain.hpp"

namespace graspfit::grasp::internal {

using Eigen::Vector3d;
using geometry::RigidTransform;

RigidTransform turned(const RigidTransform& X_OH, const Vector3d& pivot, const Vector3d& axis,
                      double angle) {
  RigidTransform turn = RigidTransform::Identity();
  turn.translate(pivot);
  turn.rotate(Eigen::AngleAxisd(angle, axis));
  turn.translate(-pivot);
  RigidTransform result = turn * X_OH;
  // Many small turns must not let the rotation drift.
  result.linear() = Eigen::Quaterniond(result.linear()).normalized().toRotationMatrix();
  return result;
}

bool is_one_sided(const hands::HandModel& hand) {
  const hands::HandConfiguration open = hands::open_configuration(hand);
  const std::vector<RigidTransform> X_HL = hands::forward_kinematics(hand, open);
  const Vector3d& axis = hand.palm.direction_H;
  const Vector3d zero_azimuth = axis.unitOrthogonal();
  std::vector<double> azimuths;
  for (const hands::Finger& finger : hand.fingers) {
    if (!finger.tip_pad) continue;
    const Vector3d tip = hands::pad_contact_point(hand, *finger.tip_pad, X_HL);
    azimuths.push_back(azimuth_error(zero_azimuth, tip - hand.palm.center_H, axis));
  }
  if (azimuths.empty()) return false;
  std::sort(azimuths.begin(), azimuths.end());
  double gap = azimuths.front() + 2.0 * std::numbers::pi - azimuths.back();
  for (std::size_t i = 1; i < azimuths.size(); ++i) {
    gap = std::max(gap, azimuths[i] - azimuths[i - 1]);
  }
  // Opposite jaws leave half a turn on either side, up to the rounding of the description.
  constexpr double kRounding = 1e-6;  // [rad]
  return gap > std::numbers::pi + kRounding;
}

Vector3d turning_point(const hands::HandModel& hand, bool is_hand_one_sided,
                       const std::vector<RigidTransform>& X_OL, const TargetContacts& targets) {
  const RigidTransform& X_OH = X_OL[hand.palm.link];
  const Vector3d palm_center = X_OH * hand.palm.center_H;
  if (!is_hand_one_sided) return palm_center;
  Vector3d to_tips = Vector3d::Zero();
  int num_fingers = 0;
  for (const TargetContact& target : targets.contacts) {
    if (target.is_palm) return palm_center;
    to_tips +=
        hands::pad_contact_point(hand, *hand.fingers[*target.finger].tip_pad, X_OL) - palm_center;
    ++num_fingers;
  }
  to_tips /= num_fingers;
  const Vector3d axis = (X_OH.linear() * hand.palm.direction_H).normalized();
  return palm_center + to_tips - to_tips.dot(axis) * axis;
}

std::vector<int> closing_joints(const hands::HandModel& hand, const hands::Finger& finger) {
  std::vector<int> alone, following, freed;
  for (const int index : finger.joints) {
    const hands::Joint& joint = hand.joints[index];
    if (joint.closing_sign == 0) continue;
    (joint.coupling ? following : alone).push_back(index);
    if (joint.coupling && joint.coupling->breakaway) freed.push_back(index);
  }
  if (alone.empty() && !following.empty()) alone = {hands::leader_of(hand, following.front())};
  alone.insert(alone.end(), freed.begin(), freed.end());
  return alone;
}

hands::HandConfiguration aligned_open_hand(const hands::HandModel& hand,
                                           const TargetContacts& targets,
                                           const PalmPlacement& placement, double distance) {
  const Vector3d direction = placement.direction_O.normalized();
  hands::HandConfiguration configuration = hands::open_configuration(hand);
  configuration.X_OH.linear() =
      Eigen::Quaterniond::FromTwoVectors(hand.palm.direction_H, direction).toRotationMatrix();
  std::vector<RigidTransform> X_OL = hands::forward_kinematics(hand, configuration);
  const bool has_palm = targets.contacts.back().is_palm;
  const Vector3d pivot =
      (has_palm ? targets.contacts.back().point_O : targets.centroid()) - distance * direction;
  configuration.X_OH.pretranslate(
      Vector3d(pivot - turning_point(hand, is_one_sided(hand), X_OL, targets)));
  const TargetContact& seed = targets.contacts.front();
  X_OL = hands::forward_kinematics(hand, configuration);
  const Vector3d tip = hands::pad_contact_point(hand, *hand.fingers[*seed.finger].tip_pad, X_OL);
  const double angle = azimuth_error(tip - pivot, seed.point_O - pivot, direction);
  configuration.X_OH = turned(configuration.X_OH, pivot, direction, angle + placement.turn);
  configuration.q = aligned_swing(hand, configuration, targets);
  return configuration;
}

}  // namespace graspfit::grasp::internal
