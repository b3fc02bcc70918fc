#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "graspfit/experiments/experiment_config.hpp"

namespace graspfit::app {

/// The commands of `graspfit experiment` that work on results.
ExitCode run_experiment_run(const std::vector<std::string>& arguments);
ExitCode run_experiment_status(const std::vector<std::string>& arguments);
ExitCode run_experiment_merge(const std::vector<std::string>& arguments);
ExitCode run_experiment_verify(const std::vector<std::string>& arguments);

/// --quick and --set.
boost::program_options::options_description config_change_options();

/// The configuration of an experiment with these changes.
experiments::ExperimentConfig load_experiment_config(const experiments::Experiment& experiment,
                                                     const Flags& flags);

/// Prints a command's help if that is asked for.
bool is_help_printed(const Command& command, const Flags& flags);

}  // namespace graspfit::app
