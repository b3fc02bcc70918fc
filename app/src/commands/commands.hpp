#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/exit_codes.hpp"

namespace graspfit::app {

/// The commands. Each takes the arguments after its name, prints results on standard output, and
/// throws UsageError or a base::Error for arguments and files that it cannot use.
ExitCode run_plan(const std::vector<std::string>& arguments);
ExitCode run_options(const std::vector<std::string>& arguments);
ExitCode run_inspect(const std::vector<std::string>& arguments);
ExitCode run_evaluate(const std::vector<std::string>& arguments);
ExitCode run_hold(const std::vector<std::string>& arguments);
ExitCode run_compare(const std::vector<std::string>& arguments);
ExitCode run_convert(const std::vector<std::string>& arguments);
ExitCode run_shape(const std::vector<std::string>& arguments);
ExitCode run_motion(const std::vector<std::string>& arguments);
ExitCode run_hand(const std::vector<std::string>& arguments);
ExitCode run_experiment(const std::vector<std::string>& arguments);
ExitCode run_dataset(const std::vector<std::string>& arguments);

/// Whether `graspfit hand` has a command of that name.
bool is_hand_command(const std::string& name);

/// Whether `graspfit experiment` has a command of that name.
bool is_experiment_command(const std::string& name);

/// Whether `graspfit dataset` has a command of that name.
bool is_dataset_command(const std::string& name);

/// The program's version and those of the compiler and the libraries it was built with.
std::string version_text();

/// The versions of `version_text` as pairs of name and version.
std::vector<std::pair<std::string, std::string>> version_rows();

}  // namespace graspfit::app
