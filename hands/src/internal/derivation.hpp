#pragma once

#include "graspfit/hands/hand_model.hpp"
#include "internal/findings.hpp"
#include "internal/sidecar.hpp"

namespace graspfit::hands::internal {

/// `given` with every member that it leaves out derived from a tree with surfaces and couplings
/// (fingers, pads and palm of `tree` itself are not read). What was derived, and by which reading,
/// is noted in `findings`. Same tree, same result.
/// @throws InvalidInput (hand, item, why, what to write into the sidecar) where nothing sensible
/// can be derived: no finger, no link that closes.
Sidecar completed(const HandModel& tree, const Sidecar& given, Findings& findings);

}  // namespace graspfit::hands::internal
