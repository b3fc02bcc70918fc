#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "graspfit/sweep/experiment.hpp"

namespace graspfit::experiments {

/// All experiments, by slug. This is the registry: one line each in experiment_registry.cpp.
const std::vector<sweep::Experiment>& all_experiments();

/// @throws InvalidInput that lists the experiments, if there is none of that name.
const sweep::Experiment& find_experiment(std::string_view slug);

/// The JSON Schema of configurations, for editors and other programs: members, names and values of
/// settings. What depends on several values at once only `read_config` checks.
std::string config_schema();

}  // namespace graspfit::experiments
