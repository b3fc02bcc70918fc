#pragma once

#include "graspfit/experiments/experiment.hpp"

/// \file
/// One function per experiment, in the source of its name.

namespace graspfit::experiments::internal {

Experiment force_closure();
Experiment hold_prediction();
Experiment hold_rates();
Experiment parameter_sweeps();
Experiment planner_everyday();
Experiment planner_paper_objects();
Experiment special_cases();
Experiment table_tidying();

}  // namespace graspfit::experiments::internal
