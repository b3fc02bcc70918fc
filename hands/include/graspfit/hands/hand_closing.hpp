#pragma once

#include <optional>
#include <vector>

#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

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

/// A finger that `closed_without_overlap` stopped on its way.
struct ClosingStop {
  std::optional<int> finger;  ///< Of the hand; empty: a joint of no finger.
  double share = 0.0;         ///< Of the way that was asked for, where it stands: in [0, 1).
  int link_a = 0;  ///< With link_b: the links that would touch with its next step; of several
  int link_b = 0;  ///< pairs the one that would overlap deepest.
};

/// What stops fingers on the way of `closed_without_overlap`, in the order in which they stop.
/// @throws InvalidInput unless 0 ≤ share ≤ 1.
std::vector<ClosingStop> closing_stops(const HandModel& model, double share);

}  // namespace graspfit::hands
