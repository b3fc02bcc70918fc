#pragma once

#include <string>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "graspfit/hold_test/hold_protocol.hpp"
#include "output/progress_bar.hpp"

namespace graspfit::app {

/// Planned grasps that hold, and what became of all.
struct HeldGrasps {
  std::vector<grasp::Grasp> grasps;  ///< Largest margin first; for protocols that lift, which have
                                     ///< none, in the order of the plan.
  grasp::HoldRecord record;
};

/// Tests planned grasps with the default convex pieces. @throws as hold_test::test_grasps.
HeldGrasps held_grasps(const geometry::TriangleMesh& object_O, const hands::HandModel& hand,
                       const hold_test::HoldProtocol& protocol, int num_threads,
                       std::vector<grasp::Grasp> planned, ProgressBar& progress);

/// "5 of 8 planned grasps hold under dexgraspbench-100g: load 2, rejected 1".
std::string hold_text(const grasp::HoldRecord& record);

}  // namespace graspfit::app
