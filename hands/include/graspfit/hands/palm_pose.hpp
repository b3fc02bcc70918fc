#pragma once

#include <Eigen/Core>
#include <optional>

#include "graspfit/hands/hand_configuration.hpp"

/// \file
/// Where a palm stands for methods that place the hand without target contacts.

namespace graspfit::hands {

/// The axis about which the fingers close, unit, normal to the palm direction, in H: of the hand
/// half closed, the direction from the thumb's tip to the middle of the other fingertips, turned
/// into the palm's plane and by a right angle in it. Of the Barrett hand the line through the bases
/// of the fingers that spread. A direction of its own choice where the thumb faces nothing.
Eigen::Vector3d closing_axis_H(const HandModel& hand);

/// The point that is to lie in the middle of what the hand holds, in H: on the palm's axis, half
/// way between the palm center and the fingertips of the hand half closed [R].
Eigen::Vector3d grasp_center_H(const HandModel& hand);

/// The pose of the palm in which its direction is `direction_O`, `axis_H` lies along `axis_O`, and
/// the point `point_H` is at `point_O`. Both directions unit, both axes unit and normal to them.
geometry::RigidTransform palm_pose(const HandModel& hand, const Eigen::Vector3d& axis_H,
                                   const Eigen::Vector3d& point_H,
                                   const Eigen::Vector3d& direction_O,
                                   const Eigen::Vector3d& axis_O, const Eigen::Vector3d& point_O);

/// The open hand with every independent joint that neither opens nor closes (spread, abduction) at
/// a share of its range.
hands::HandConfiguration open_hand_spread_by(const HandModel& hand, double share);

/// Angle between a direction of the palm and the one asked for [rad]; 0 where none is. Lengths do
/// not matter.
double angle_from_approach(const Eigen::Vector3d& direction_O,
                           const std::optional<Eigen::Vector3d>& approach_O);

/// A unit vector normal to a unit vector.
Eigen::Vector3d any_normal(const Eigen::Vector3d& direction);

/// `axis` turned about the unit `direction`, to which it is normal.
Eigen::Vector3d turned_axis(const Eigen::Vector3d& axis, const Eigen::Vector3d& direction,
                            double angle);

}  // namespace graspfit::hands
