#pragma once

#include <Eigen/Core>
#include <vector>

#include "graspfit/grasp/palm_placement.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "graspfit/hands/hand_configuration.hpp"

/// \file
/// How a hand is turned toward its targets, and which joints of a finger close it.

namespace graspfit::grasp::internal {

/// `X_OH` turned by `angle` about the line through `pivot` along the unit `axis`.
geometry::RigidTransform turned(const geometry::RigidTransform& X_OH, const Eigen::Vector3d& pivot,
                                const Eigen::Vector3d& axis, double angle);

/// Whether all fingertips of the open hand lie to one side of its palm center, seen along the palm
/// direction: such a hand, as the human one, holds things before its fingers, not before its palm.
bool is_one_sided(const hands::HandModel& hand);

/// The point that is placed before the targets and about which the hand turns: the palm center [P];
/// for a one-sided hand the mean of the fingertips with targets, projected onto the plane through
/// the palm center normal to the palm direction, because otherwise the targets would lie behind the
/// bases of its fingers [R].
Eigen::Vector3d turning_point(const hands::HandModel& hand, bool is_hand_one_sided,
                              const std::vector<geometry::RigidTransform>& X_OL,
                              const TargetContacts& targets);

/// The joints that close a finger one after the other, proximal to distal: its independent closing
/// ones or, where all follow (a gripper's second jaw), the leader of the first; then those that a
/// clutch frees (breakaway).
std::vector<int> closing_joints(const hands::HandModel& hand, const hands::Finger& finger);

/// The open hand, its palm facing along `placement` and its turning point `distance` before the
/// targets' centroid (where the palm has a target: before that target). The hand is turned until
/// the seed's finger points at the seed, and then by the placement's turn; the other fingers are
/// swung to their targets. A thumb that swings by itself stands where the others' swings come
/// closest to their targets.
hands::HandConfiguration aligned_open_hand(const hands::HandModel& hand,
                                           const TargetContacts& targets,
                                           const PalmPlacement& placement, double distance);

}  // namespace graspfit::grasp::internal
