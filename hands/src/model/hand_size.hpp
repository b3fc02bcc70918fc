#pragma once

#include "graspfit/hands/hand_model.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// The longest extent of all link surfaces together, every joint at the position nearest zero [m].
double extent_at_rest(const HandModel& tree);

/// Larger is no hand [m]. What measures how a hand closes is made for meters, and takes minutes for
/// millimeters.
constexpr double kLargestHand = 1.0;

/// Notices a hand that is larger than 1 m or smaller than 1 cm: the longest extent of all its link
/// surfaces together, every joint at the position nearest zero. Where another unit would make a
/// hand of it, the finding names the factor, the unit, and where to write it. `tree` has surfaces
/// and couplings; `meters_per_unit` is that of its description.
/// @throws InvalidInput beyond 10 km: nothing that the hand is measured by has room for that.
void check_size(const HandModel& tree, double meters_per_unit, Findings& findings);

}  // namespace graspfit::hands::internal
