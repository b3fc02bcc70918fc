#pragma once

#include <string>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/grasp/planner_options.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/hands/hand_io.hpp"

namespace graspfit::app {

/// Advice on what to change after a run without grasps, to be printed after its outcomes; empty if
/// nothing stands out. If most attempts found no targets, it gives the reason, the sizes that did
/// not fit, and the flags to change. If the hand is suspicious, it says that this may be the
/// reason.
std::string no_grasp_advice(const grasp::PlannerResult& result,
                            const grasp::PlannerOptions& options,
                            const geometry::TriangleMesh& object, const hands::HandReading& hand);

}  // namespace graspfit::app
