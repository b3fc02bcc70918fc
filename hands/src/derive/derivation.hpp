#pragma once

#include "description/sidecar.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// Returns `given` with every member that it leaves out derived from a tree with surfaces and
/// couplings (fingers, pads and palm of `tree` itself are not read). What was derived, and how, is
/// noted in `findings`. The same tree gives the same result, since samples are seeded.
///
/// Links that fixed joints join are one **body**; body 0, of the root link, is the palm. At
/// **rest** every joint is at the value nearest zero; **half closed**, every closing joint is in
/// the middle of its range and the others are at rest. Followers are where their leaders put them.
///
/// **Fingers.** Every leaf of the tree of bodies ends a finger, after bodies without a surface are
/// cut off the leaves; the finger is the chain from the palm to the leaf. There are two exceptions.
/// A chain all of whose joints follow is a bar of a linkage and no finger if another chain has the
/// same leaders, reaches farther, and touches it in all of five sampled configurations. Where a
/// branch forks, the bodies before the fork belong to the finger that reaches farthest. A finger is
/// named by the common prefix of its links' names, if the prefixes tell the fingers apart; else the
/// names are finger_1, finger_2, ….
///
/// **Closing.** An independent joint *bends* a finger if it is prismatic, or if its axis at rest is
/// within 50 degrees of the axis of the finger's last joint; the axis of a follower counts for its
/// leader. The spread of the hand is the sum, over the fingertips, of the distance from the palm's
/// middle plus the mean distance from the other tips. The gain of a joint is how much smaller the
/// spread is at its upper limit than at its lower one, summed over 48 sampled configurations of the
/// other joints. All joints that bend a finger bend it in the same sense: the sum of their gains,
/// each with the sign that turns the joint's axis to the last joint's, decides in which. Any other
/// joint closes if it moves the half-closed fingertip along the palm's direction by at least half
/// of the length of the tip's path (a thumb's opposition); the joint that moves it farthest is
/// decided first. The remaining joints are neutral, and the one whose axis is nearest to the palm's
/// direction is the finger's **swing joint**.
///
/// **Facing.** A body of a finger faces the direction in which its joint turns it when closing:
/// normal to the axis and to the line from its joint to the next joint or to the tip. A body that
/// hardly turns (a jaw, a parallelogram) faces the direction in which it moves.
///
/// **Palm.** The half-closed fingers face a point, the one nearest to all lines along which their
/// bodies face. The front of the palm is the side that takes up most of the view from this point.
/// If more than half of the fingers face the same direction at rest (within 45 degrees), and it is
/// within 50 degrees of the front's normal, it is the palm's direction. Otherwise (jaws) the
/// front's normal is. A direction within 3 degrees of an axis of the root link becomes this axis.
/// The palm's center is on its surface below the point that the fingers face.
///
/// **Thumb.** Of three fingers or more, the thumb is the one whose tip motion from open to half
/// closed, projected across the palm's direction, agrees least with the other tips' motions. Its
/// mean cosine must be the lowest by 0.2; else there is no thumb.
///
/// **Pads.** There is one pad per link with a surface that a bending joint moves, on the side that
/// the link faces while half closed, and one on the palm, around its center and no farther out than
/// the fingers' first joints and half-closed tips; see `fit_pad`. A surface of less than 20 mm² is
/// no pad. Neither is one that faces its own finger, the palm or a bar of a linkage within 50 mm
/// both while the hand is open and half closed, unless it is on the tip. The last pad of a finger
/// is its tip pad.
///
/// **Exclusions.** See `derived_exclusions`.
///
/// Given members are taken as they are, and the others are derived from them: given fingers are the
/// chains, given closing signs decide what links face, a given palm sets the direction and center,
/// and given pads name the fingers that they are on.
/// @throws InvalidInput (hand, item, why, what to write into the sidecar) where nothing sensible
/// can be derived: no finger, no link that closes.
Sidecar completed(const HandModel& tree, const Sidecar& given, Findings& findings);

}  // namespace graspfit::hands::internal
