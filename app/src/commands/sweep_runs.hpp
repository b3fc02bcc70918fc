#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "graspfit/sweep/run_manifest.hpp"
#include "graspfit/sweep/sweep_runner.hpp"
#include "graspfit/sweep/sweep_shards.hpp"

/// \file
/// What commands that run experiments, under whatever name, do and print alike.

namespace graspfit::app {

/// What of a run's manifest is known beforehand; `command` is "experiment run" or the like.
sweep::RunManifest begun_manifest(const std::string& command,
                                  const std::vector<std::string>& arguments);

/// `sweep::run_sweep` with a progress bar unless it is to be quiet.
sweep::RunProgress run_with_progress(const sweep::Experiment& experiment,
                                     const sweep::ExperimentConfig& config,
                                     const sweep::RunManifest& manifest,
                                     const sweep::RunOptions& options, bool is_quiet);

/// Prints how many cells have which state, and the first reason.
void print_run(const sweep::RunProgress& done);

/// Prints the status of a sweep's runs, a line each.
void print_status(const std::vector<sweep::SweepStatus>& statuses);

}  // namespace graspfit::app
