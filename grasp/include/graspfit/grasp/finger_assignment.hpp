#pragma once

#include "graspfit/grasp/palm_placement.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::grasp {

/// Assigns targets to fingers: the seed to the first finger of `parts`, the others by the
/// permutation with the least angular error around the palm axis. The palm's target stays the
/// palm's.
/// @throws InvalidInput unless there is one target for every part, the palm's (if any) last.
TargetContacts assign_fingers(const hands::HandModel& hand, const TargetContacts& targets,
                              const RequestedParts& parts, const PalmPlacement& placement);

}  // namespace graspfit::grasp
