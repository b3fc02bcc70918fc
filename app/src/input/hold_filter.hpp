#pragma once

#include <string>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "graspfit/hold_test/hold_protocol.hpp"
#include "output/progress_bar.hpp"

namespace graspfit::app {

/// The planned grasps that hold, and a record of the tests of all planned grasps.
struct HeldGrasps {
  std::vector<grasp::Grasp> grasps;  ///< By margin, the largest first, or in the order of the plan.
  grasp::HoldRecord record;
};

/// Tests planned grasps with the default convex pieces. @param by_margin the largest margin first;
/// without, and for protocols that lift, which have no margins, the order stays. @throws as
/// hold_test::test_grasps.
HeldGrasps held_grasps(const geometry::TriangleMesh& object_O, const hands::HandModel& hand,
                       const hold_test::HoldProtocol& protocol, int num_threads,
                       std::vector<grasp::Grasp> planned, bool by_margin, ProgressBar& progress);

/// The record as text: "5 of 8 planned grasps hold under dexgraspbench-100g: load 2, rejected 1".
std::string hold_text(const grasp::HoldRecord& record);

}  // namespace graspfit::app
