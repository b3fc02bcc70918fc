#pragma once

#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// Every joint that closes the hand at `share` of the way from open (0) to the limit that closes it
/// (1), neutral ones as in `open_configuration`; coupled joints follow. Fingers may pass through
/// each other: `closed_without_overlap` stops them. @throws InvalidInput unless 0 ≤ share ≤ 1.
HandConfiguration closed_configuration(const HandModel& model, double share);

/// The hand closed around nothing, up to `share` of the way of `closed_configuration`.
///
/// All fingers close together in 64 equal steps, those listed first a step ahead; a finger stops
/// for good before the step with which links would touch that are apart while the hand is open
/// (collision exclusions of the model besides). Joints that move links of several fingers belong to
/// the first of them; joints of no finger stop on their own. So what is returned overlaps itself no
/// more than the open hand does: exact on the true meshes, as `HandCollision`, at the steps;
/// between them nothing is tested. Same model, same result. Cost: up to 64 self-collision tests per
/// finger.
/// @throws InvalidInput unless 0 ≤ share ≤ 1.
HandConfiguration closed_without_overlap(const HandModel& model, double share);

}  // namespace graspfit::hands
