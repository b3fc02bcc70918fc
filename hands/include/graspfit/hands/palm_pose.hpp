#pragma once

#include <Eigen/Core>
#include <optional>

#include "graspfit/hands/hand_configuration.hpp"

/// \file
/// Palm poses for planning methods that place the hand without target contacts.

namespace graspfit::hands {

/// The axis about which the fingers close, in H: a unit vector normal to the palm direction. It is
/// the direction from the thumb's tip to the mean of the other fingertips of the half-closed hand,
/// projected onto the palm's plane and turned by a right angle in this plane. For the Barrett hand
/// it is the direction of the line through the bases of the fingers that spread. It is an arbitrary
/// normal of the palm direction where the projection vanishes or there is no finger but the thumb.
Eigen::Vector3d closing_axis_H(const HandModel& hand);

/// The point that is to lie in the middle of the held object, in H. It is on the line from the palm
/// center along the palm direction, at half the mean height of the half-closed hand's fingertips
/// over the palm center [R].
Eigen::Vector3d grasp_center_H(const HandModel& hand);

/// The pose of the palm in which its direction is `direction_O`, `axis_H` lies along `axis_O`, and
/// the point `point_H` is at `point_O`. `direction_O` and both axes are unit vectors; the axes are
/// normal to the palm direction.
geometry::RigidTransform palm_pose(const HandModel& hand, const Eigen::Vector3d& axis_H,
                                   const Eigen::Vector3d& point_H,
                                   const Eigen::Vector3d& direction_O,
                                   const Eigen::Vector3d& axis_O, const Eigen::Vector3d& point_O);

/// The open hand with every independent joint that neither opens nor closes (spread, abduction) at
/// a share of its range.
hands::HandConfiguration open_hand_spread_by(const HandModel& hand, double share);

/// Angle between a palm direction and the requested approach direction [rad]; 0 without a request.
/// The lengths of the vectors do not matter.
double angle_from_approach(const Eigen::Vector3d& direction_O,
                           const std::optional<Eigen::Vector3d>& approach_O);

/// A unit vector normal to a unit vector.
Eigen::Vector3d any_normal(const Eigen::Vector3d& direction);

/// `axis` turned about the unit `direction`, to which it is normal.
Eigen::Vector3d turned_axis(const Eigen::Vector3d& axis, const Eigen::Vector3d& direction,
                            double angle);

}  // namespace graspfit::hands
