#pragma once

#include <span>
#include <string>
#include <vector>

#include "cli/exit_codes.hpp"

namespace graspfit::app {

/// A command by its name.
struct NamedCommand {
  const char* name;
  /// Runs the command with the arguments after its name.
  ExitCode (*run)(const std::vector<std::string>& arguments);
};

/// The command of that name; null if there is none.
const NamedCommand* find_command(std::span<const NamedCommand> commands, const std::string& name);

/// Runs the command that the first argument names, or prints `usage` for `--help`, `-h` and `help`.
/// `family` is the word before the name: "hand", or empty for commands of the program itself.
/// @throws UsageError that lists the commands, if there is none of that name.
ExitCode run_command(std::span<const NamedCommand> commands, const std::string& family,
                     const char* usage, const std::vector<std::string>& arguments);

}  // namespace graspfit::app
