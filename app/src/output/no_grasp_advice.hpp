#pragma once

#include <string>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/grasp/planner_options.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/grasp/surroundings.hpp"
#include "graspfit/hands/hand_io.hpp"

namespace graspfit::app {

/// A run that found no grasps.
struct RunWithoutGrasps {
  const grasp::PlannerResult& result;
  const grasp::PlannerOptions& options;
  const geometry::TriangleMesh& object_O;
  const hands::HandReading& hand;
  const grasp::Surroundings& surroundings;
  /// The object was laid down in one rest pose, and not in all.
  bool is_in_one_rest_pose = false;
  /// Targets by the hand's reach were tried before, without success.
  bool is_reach_tried = false;
};

/// Advice on what to change after a run without grasps, to be printed after its outcomes; empty if
/// nothing stands out. It says what stopped most attempts and which flags, that are not at their
/// limits, would help: in free space if most found no targets, with the sizes that did not fit;
/// over a table or beside obstacles for every outcome, with what else would help there. If the hand
/// is suspicious, it says that this may be the reason.
std::string no_grasp_advice(const RunWithoutGrasps& run);

}  // namespace graspfit::app
