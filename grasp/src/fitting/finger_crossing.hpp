#pragma once

#include "fitting/target_posture.hpp"
#include "graspfit/grasp/fitting_hand.hpp"
#include "graspfit/grasp/hand_fitting.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "graspfit/hands/hand_configuration.hpp"

/// \file
/// Fingers that obstruct each other: which links meet, and to which positions fingers without
/// targets move instead.

namespace graspfit::grasp::internal {

/// Whether the solids of two links meet; exact for rotations to 1e-9. False without a solid.
bool do_links_meet(const FittingHand& hand, int link_a, int link_b,
                   const geometry::RigidTransform& X_AB);

/// The hand as the fitting loop starts with it: closing joints are open, everything else is as in
/// `goal`.
hands::HandConfiguration opened_from(const hands::HandModel& hand,
                                     const hands::HandConfiguration& goal);

/// Whether links of the hand opened from `goal` meet, except pairs that the model excludes.
/// Straight fingers reach farthest: fingers that do not cross when open are beside each other as
/// they close.
bool do_fingers_cross(const FittingHand& hand, const hands::HandConfiguration& goal);

/// `goal` with the swing joints of fingers without a target turned, as little as necessary, to
/// positions in which the opened hand's fingers do not meet or, where there are none, the fewest
/// links meet. By this a finger that swings to its target takes its neighbors along. Fingers are
/// turned one at a time, the one nearest to those already placed first; turns are tried in steps of
/// a sixteenth of the joint's range.
hands::HandConfiguration with_fingers_apart(const FittingHand& hand, const TargetContacts& targets,
                                            hands::HandConfiguration goal);

/// The goal toward which the fitting loop moves the hand: `posture`, the posture at the targets,
/// with fingers apart where `options` guard the hand against itself.
hands::HandConfiguration fitting_goal(const FittingHand& hand, const TargetContacts& targets,
                                      const TargetPosture& posture, const FittingOptions& options);

}  // namespace graspfit::grasp::internal
