#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cells/planning_table.hpp"
#include "graspfit/sweep/experiment.hpp"

namespace graspfit::experiments::internal {

/// What an experiment's table says of a run of the planner before `planning_columns`.
struct OwnColumns {
  std::vector<sweep::Column> columns;
  std::function<void(const Planned&, sweep::ResultRow&)> fill;  ///< Empty where there are none.
};

/// An experiment whose cell is one run of the planner and whose columns are its own, if it has any,
/// and those about all that was found (`planning_columns`). The best grasps are kept beside the
/// row.
sweep::Experiment planner_table_experiment(const std::string& slug, const OwnColumns& own = {});

}  // namespace graspfit::experiments::internal
