#pragma once

#include <string>
#include <vector>

#include "graspfit/hands/hand_model.hpp"
#include "graspfit/viewer/hand_page.hpp"

namespace graspfit::app {

/// The poses that the words of --pose name: `open`, `half` and `closed` each start a pose,
/// JOINT=VALUE [rad or m] changes the pose before it, or the open hand if there is none; coupled
/// joints follow. `half` and `closed` are poses of `hands::closed_without_overlap`.
/// @throws UsageError for other words and for values that are no numbers; InvalidInput for joints
/// that the hand does not have, values outside their limits, and joints that follow another.
std::vector<viewer::HandPose> read_poses(const std::vector<std::string>& words,
                                         const hands::HandModel& hand);

}  // namespace graspfit::app
