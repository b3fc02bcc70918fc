#pragma once

#include <string>

#include "cells/method_summary.hpp"
#include "graspfit/sweep/experiment.hpp"
#include "graspfit/sweep/experiment_config.hpp"

namespace graspfit::experiments::internal {

/// The axis of methods; that of objects is `sweep::kObjectAxis`.
inline constexpr const char* kMethodAxis = "planner";

/// An experiment whose cell is one run of one planning method on one object until it has as many
/// grasps as were asked for, each in its row of the details with all that is measured of it. The
/// summary has the mean M of all methods side by side, as the paper's Table 1 has it; a further
/// table, `correlations`, says how much the measures agree on which grasps are better.
///
/// All cells plan with the same seed, the setting `planner-seed`, instead of seeds of their own.
sweep::Experiment method_experiment(const std::string& slug, const MethodTableAxes& axes = {});

}  // namespace graspfit::experiments::internal
