#pragma once

#include <optional>
#include <vector>

#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// The hand closed without an object, up to `share` of the range from open to closed, as in
/// `closed_configuration`.
///
/// All fingers close together in 64 equal steps; within each step they move one after the other, in
/// the order in which the model lists them. A finger stops for good before the step that would make
/// links touch that are apart while the hand is open; pairs that the model excludes from collision
/// do not count. Joints that move links of several fingers belong to the first of them; joints of
/// no finger stop on their own. In the result therefore only links touch that also touch in the
/// open hand, or that the model excludes; how deep these overlap is not tested. This is exact on
/// the true meshes, as in `HandCollision`, at the steps; between them nothing is tested. The same
/// model gives the same result. Cost: up to 64 self-collision tests per finger.
/// @throws InvalidInput unless 0 ≤ share ≤ 1.
HandConfiguration closed_without_overlap(const HandModel& model, double share);

/// A finger that `closed_without_overlap` stopped before the requested share.
struct ClosingStop {
  std::optional<int> finger;  ///< Index of the finger; empty: a joint of no finger.
  double share = 0.0;         ///< Share of the requested motion at which it stopped, in [0, 1).
  int link_a = 0;  ///< With link_b: the links that would touch with its next step; of several
  int link_b = 0;  ///< pairs the one that would overlap deepest.
};

/// What stops the fingers while `closed_without_overlap` closes them, in the order in which they
/// stop.
/// @throws InvalidInput unless 0 ≤ share ≤ 1.
std::vector<ClosingStop> closing_stops(const HandModel& model, double share);

}  // namespace graspfit::hands
