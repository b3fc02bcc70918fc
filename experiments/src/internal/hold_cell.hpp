#pragma once

#include <array>
#include <string>

#include "graspfit/experiments/experiment.hpp"

namespace graspfit::experiments::internal {

/// Protocols of the hold test under which every grasp is put, and what columns call them.
struct TestedProtocol {
  const char* name;
  const char* prefix;
};
inline constexpr std::array<TestedProtocol, 3> kTestedProtocols = {
    {{"dexgraspbench-100g", "normal_"},
     {"dexonomy-hard", "hard_"},
     {"multidex-0.05g", "multidex_"}}};

/// Column names of a grasp's details that others read.
inline constexpr std::array<const char*, 6> kGraspMetrics = {"m",  "m1",      "m2",
                                                             "m3", "epsilon", "volume"};
inline constexpr const char* kStageColumn = "stage";  ///< After a protocol's prefix.
inline constexpr const char* kHeldStage = "held";
inline constexpr std::array<const char*, 2> kMarginColumns = {"margin_force_n", "margin_torque_nm"};

/// An experiment whose cell plans with a fixed number of attempts and puts every valid grasp to the
/// hold test; nothing is filtered by the simulator. A row per cell, and one per grasp in its
/// details. Cells are skipped in builds without a physics engine.
Experiment hold_experiment(const std::string& slug);

}  // namespace graspfit::experiments::internal
