#pragma once

#include <Eigen/Core>

#include "graspfit/grasp/target_contacts.hpp"
#include "graspfit/hands/hand_configuration.hpp"

/// \file
/// Directions around the palm: how far a finger is from looking at its target, and the turn of the
/// hand and of its swinging joints that brings it there. Steps 3 and 4 of the paper's loop and its
/// initial configuration share these.

namespace graspfit::grasp {

/// Signed angle [rad] that turns `from` toward `to` about the unit `axis`, both seen along it, in
/// (−π, π]; zero where one of them is parallel to the axis.
double azimuth_error(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                     const Eigen::Vector3d& axis);

/// `X_OH` turned by `angle` about the line through `pivot` along the unit `axis`.
geometry::RigidTransform turned(const geometry::RigidTransform& X_OH, const Eigen::Vector3d& pivot,
                                const Eigen::Vector3d& axis, double angle);

/// Joint positions in which every finger that can swing around the palm looks at its assigned
/// target as well as the joints allow; fingers that share a joint take the least sum of squared
/// errors (A26). Other joints as in `configuration`.
Eigen::VectorXd aligned_swing(const hands::HandModel& hand,
                              const hands::HandConfiguration& configuration,
                              const TargetContacts& targets);

/// Sum of squared azimuth errors of all assigned fingers but the seed's [rad²].
double swing_error(const hands::HandModel& hand, const hands::HandConfiguration& configuration,
                   const TargetContacts& targets);

/// The hand open, its palm direction along `direction_O` (unit), the palm center `distance` before
/// the targets' centroid, the seed's finger turned to the seed, the others swung to their targets.
hands::HandConfiguration aligned_open_hand(const hands::HandModel& hand,
                                           const TargetContacts& targets,
                                           const Eigen::Vector3d& direction_O, double distance);

}  // namespace graspfit::grasp
