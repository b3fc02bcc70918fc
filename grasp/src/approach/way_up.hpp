#pragma once

#include "graspfit/grasp/pre_grasp.hpp"
#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::grasp::internal {

/// Whether the hand, and the object with it, can go straight up (along z of O) from the grasp by
/// the 0.1 m of the lift test without touching obstacles: proven as ways in are (`StraightWay`), of
/// the object from 1 mm on, as it may stand on an obstacle. Obstacles that touch it even there, on
/// which it leans, do not count for it. True without obstacles: a table is below.
/// @param grasp clear of the obstacles
bool is_way_up_free(const PreGraspScene& scene, const hands::PosedConfiguration& grasp);

}  // namespace graspfit::grasp::internal
