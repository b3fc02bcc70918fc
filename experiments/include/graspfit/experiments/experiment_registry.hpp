#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "graspfit/sweep/experiment.hpp"

namespace graspfit::experiments {

/// All experiments, by slug. This is the registry: one line each in experiment_registry.cpp.
const std::vector<sweep::Experiment>& all_experiments();

/// Returns the experiment of that slug, or that of data sets, which answers no question and has no
/// shipped configuration (`dataset_experiment`). @throws InvalidInput that lists the experiments,
/// if there is none.
const sweep::Experiment& find_experiment(std::string_view slug);

/// The JSON Schema of configurations, for editors and other programs: members, names and values of
/// settings. Rules between several values are checked by `read_config` only.
std::string config_schema();

}  // namespace graspfit::experiments
