#pragma once

#include <string>

#include "graspfit/sweep/experiment.hpp"

namespace graspfit::experiments::internal {

/// An experiment whose cell is one run of the planner and whose columns are about all that it found
/// (`planning_columns`). Its best grasps are kept beside the row.
sweep::Experiment planner_table_experiment(const std::string& slug);

}  // namespace graspfit::experiments::internal
