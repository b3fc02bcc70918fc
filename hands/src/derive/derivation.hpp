#pragma once

#include "description/sidecar.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// `given` with every member that it leaves out derived from a tree with surfaces and couplings
/// (fingers, pads and palm of `tree` itself are not read). What was derived, and by which reading,
/// is noted in `findings`. Same tree, same result: samples are seeded.
///
/// Links that fixed joints join are one **body**; body 0, of the root link, is the palm. Rest is
/// every joint at the value nearest zero; half closed is every closing joint in the middle of its
/// range and the others at rest; followers stand where their leaders put them.
///
/// **Fingers.** Every leaf of the tree of bodies that has a surface ends a finger (bodies without
/// one are cut off a leaf); the finger is the chain from the palm to it. Two exceptions. A chain
/// that only follows, on the same leaders as another, touches that one in all of five sampled
/// configurations and reaches less far is a bar of a linkage and no finger. Where a branch forks,
/// what comes before the fork belongs to the finger that reaches farthest. Names are what the names
/// of a finger's links begin with, if that tells the fingers apart, else finger_1, finger_2, ….
///
/// **Closing.** An independent joint *bends* a finger if it slides, or if its axis at rest is
/// within 50 degrees of that of the finger's last joint; a follower's counts for its leader. Its
/// gain is how much less spread out the hand is at its upper limit than at its lower one: of every
/// fingertip the distance from the palm's middle plus the mean one from the other tips, summed over
/// 48 sampled configurations of the other joints. All joints that bend a finger bend it the same
/// way: the sum of their gains decides which, each turned to the last joint's axis. Any other joint
/// closes if it moves the half-closed fingertip along the palm's direction by at least half of the
/// tip's way (a thumb's opposition), the one that does so most first. The rest are neutral, and
/// that whose axis is nearest to the palm's direction is the finger's **swing joint**.
///
/// **Facing.** A body of a finger faces where its joint turns it when closing: across the axis and
/// the line from its joint to the next one or to its tip. A body that hardly turns (a jaw, a
/// parallelogram) faces where it goes.
///
/// **Palm.** If more than half of the fingers face the same way at rest (within 45 degrees), that
/// is the palm's direction; it must be within 50 degrees of the side of the palm that takes up most
/// of the view from the point which the half-closed fingers face (nearest to all lines along which
/// their bodies face). Where fingers do not agree (jaws), it is that side's normal. Directions
/// within 3 degrees of an axis of the root link are that axis. The center is the palm's surface
/// under that point.
///
/// **Thumb.** Of three fingers or more the one whose tip, from open to half closed and across the
/// palm's direction, goes least with the others, by 0.2 in the mean cosine; else none.
///
/// **Pads.** One per link with a surface that a bending joint moves, where it faces while half
/// closed, and one on the palm, around its center and no farther out than the fingers' first joints
/// and half-closed tips; see `fit_pad`. Less than 20 mm² is no pad, nor is one that looks at its
/// own finger, the palm or a bar within 50 mm both open and half closed, unless it is the tip's.
/// The last one of a finger is its tip pad.
///
/// **Exclusions.** See `derived_exclusions`.
///
/// Given members are taken as they are and the others follow them: given fingers are the chains,
/// given closing signs the way in which links face, a given palm the direction and center; given
/// pads name the fingers that they are on.
/// @throws InvalidInput (hand, item, why, what to write into the sidecar) where nothing sensible
/// can be derived: no finger, no link that closes.
Sidecar completed(const HandModel& tree, const Sidecar& given, Findings& findings);

}  // namespace graspfit::hands::internal
