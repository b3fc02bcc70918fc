#pragma once

#include "graspfit/hands/hand_model.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// The longest extent of all link surfaces together, every joint at the position nearest zero [m].
double extent_at_rest(const HandModel& tree);

/// Largest extent of a hand [m]. The checks of how a hand closes are made for meters, and take
/// minutes if its lengths are millimeters.
constexpr double kLargestHand = 1.0;

/// Notices a hand that is larger than 1 m or smaller than 1 cm: the longest extent of all its link
/// surfaces together, every joint at the position nearest zero. Where another unit would make a
/// hand of it, the finding names the factor, the unit, and where to write it. `tree` has surfaces
/// and couplings; `meters_per_unit` is the one of its description.
/// @throws InvalidInput beyond 10 km, which is outside the range of all measurements of a hand.
void check_size(const HandModel& tree, double meters_per_unit, Findings& findings);

}  // namespace graspfit::hands::internal
