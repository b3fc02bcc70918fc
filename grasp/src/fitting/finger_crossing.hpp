#pragma once

#include "fitting/target_posture.hpp"
#include "graspfit/grasp/fitting_hand.hpp"
#include "graspfit/grasp/hand_fitting.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "graspfit/hands/hand_configuration.hpp"

/// \file
/// Fingers that stand in each other's way: which links meet, and where fingers without targets had
/// better be.

namespace graspfit::grasp::internal {

/// Whether the solids of two links share a point. Exact; false for a link without a solid.
bool do_links_meet(const FittingHand& hand, int link_a, int link_b,
                   const geometry::RigidTransform& X_AB);

/// The hand as the fitting loop starts with it: what closes is open, all else is as at `goal`.
hands::HandConfiguration opened_from(const hands::HandModel& hand,
                                     const hands::HandConfiguration& goal);

/// Whether links of the hand opened from `goal` meet, exclusions of the model left out. Straight
/// fingers reach farthest: those that do not cross then are beside each other as they close.
bool do_fingers_cross(const FittingHand& hand, const hands::HandConfiguration& goal);

/// `goal` with the swinging joints of fingers without a target turned, as little as it takes, to
/// where the opened hand's fingers do not meet: a finger that swings to
/// its target takes its neighbors along. Where that cannot be, to where the fewest links meet. One
/// finger at a time, the one nearest to those that are placed first; turns are tried in steps of a
/// sixteenth of the joint's range.
hands::HandConfiguration with_fingers_apart(const FittingHand& hand, const TargetContacts& targets,
                                            hands::HandConfiguration goal);

/// Where the fitting loop leads the hand: `posture`, that of the targets, with fingers apart where
/// `options` guard the hand against itself.
hands::HandConfiguration fitting_goal(const FittingHand& hand, const TargetContacts& targets,
                                      const TargetPosture& posture, const FittingOptions& options);

}  // namespace graspfit::grasp::internal
