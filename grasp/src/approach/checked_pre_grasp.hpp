#pragma once

#include <optional>

#include "graspfit/grasp/pre_grasp.hpp"

namespace graspfit::grasp::internal {

/// The pre-grasp that starts at `start`, if the hand is clear there by `clearance` and the straight
/// way from it to the grasp is proven free, both as `find_pre_grasp` wants them; else empty. Its
/// `opening` is the largest share over the closing joints, 0 where none of them opens, and its
/// `retreat` the way of the palm against its direction, 0 if that goes the other way.
/// @throws as `find_pre_grasp`.
std::optional<PreGrasp> checked_pre_grasp(const hands::HandModel& hand,
                                          const hands::HandCollision& collision,
                                          const geometry::MeshQuery& object,
                                          const SurroundingsCollision& surroundings,
                                          const hands::HandConfiguration& start,
                                          const hands::HandConfiguration& grasp,
                                          const PreGraspOptions& options);

}  // namespace graspfit::grasp::internal
