#pragma once

#include <vector>

#include "graspfit/grasp/grasp_scene.hpp"
#include "graspfit/grasp/hand_fitting.hpp"
#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::grasp::internal {

/// A grasp whose other fingertips hold, too: each finger that is not among `used` closes by its own
/// joints as `close_hand` closes them, by exact guards against object, surroundings and hand, and
/// stays closed if the object then lies in the clip volume of its fingertip's pad, on the pad or,
/// where something else stopped it, close before it; else it stays where it was. Of a finger that
/// touches with a link behind its tip the joints beyond that link close. The palm and all links of
/// other fingers stay where they are: a finger that cannot close without them, as the jaw of a
/// gripper, stays.
///
/// @param grasp clear of the object, the surroundings and itself
/// @param options those by which the hand was fitted; guards and contact state are set here
hands::HandConfiguration with_idle_fingers_closed(const GraspScene& scene,
                                                  const hands::HandConfiguration& grasp,
                                                  const std::vector<int>& used,
                                                  FittingOptions options);

}  // namespace graspfit::grasp::internal
