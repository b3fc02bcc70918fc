#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "graspfit/sweep/experiment_config.hpp"

namespace graspfit::app {

/// The commands of `graspfit experiment` on one experiment.
ExitCode run_experiment_describe(const std::vector<std::string>& arguments);
ExitCode run_experiment_run(const std::vector<std::string>& arguments);
ExitCode run_experiment_status(const std::vector<std::string>& arguments);
ExitCode run_experiment_merge(const std::vector<std::string>& arguments);
ExitCode run_experiment_verify(const std::vector<std::string>& arguments);

/// The options that change a configuration: --quick, --set, --object and --longest.
boost::program_options::options_description config_change_options();

/// The configuration of an experiment with the changes that these options make, to be described.
sweep::ExperimentConfig load_experiment_config(const sweep::Experiment& experiment,
                                               const Flags& flags);

/// The configuration with these changes, to be run on this machine: if there is no data folder,
/// values that need it are left out where others remain.
sweep::ExperimentConfig load_config_to_run(const sweep::Experiment& experiment, const Flags& flags);

/// What a command on one experiment was called with.
struct ExperimentCall {
  Flags flags;
  const sweep::Experiment& experiment;  ///< The one that SLUG names.
};

/// Reads the arguments of a command on one experiment. If help is requested, it is printed, and the
/// result is empty.
std::optional<ExperimentCall> experiment_call(const Command& command,
                                              const std::vector<std::string>& arguments);

/// Prints a command's help if it is requested. Returns whether it is.
bool is_help_printed(const Command& command, const Flags& flags);

}  // namespace graspfit::app
