#pragma once

#include <string>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/grasp/planner_options.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/hands/hand_io.hpp"

namespace graspfit::app {

/// What to change after a run without grasps, to follow its outcomes; empty where nothing stands
/// out. Where most attempts found no targets: why, with the sizes that did not fit, and the flags.
/// Where the hand is suspicious: that this may be why.
std::string no_grasp_advice(const grasp::PlannerResult& result,
                            const grasp::PlannerOptions& options,
                            const geometry::TriangleMesh& object, const hands::HandReading& hand);

}  // namespace graspfit::app
