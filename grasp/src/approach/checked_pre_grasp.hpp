#pragma once

#include <optional>

#include "graspfit/grasp/pre_grasp.hpp"

namespace graspfit::grasp::internal {

/// The pre-grasp that starts at `start`, if the hand is clear there by `clearance` and the straight
/// path from `start` to the grasp is proven free, both as `find_pre_grasp` requires; else empty.
/// The pre-grasp's `opening` is the largest share over the closing joints, 0 where none of them
/// opens; its `retreat` is the distance that the palm is withdrawn against its direction, 0 if the
/// palm is advanced instead.
/// @throws as `find_pre_grasp`.
std::optional<PreGrasp> checked_pre_grasp(const PreGraspScene& scene,
                                          const hands::HandConfiguration& start,
                                          const hands::HandConfiguration& grasp,
                                          const PreGraspOptions& options);

}  // namespace graspfit::grasp::internal
