#pragma once

#include <string>
#include <vector>

#include "cli/exit_codes.hpp"

namespace graspfit::app {

/// The commands below `graspfit hand`, as those of commands.hpp.
ExitCode run_hand_list(const std::vector<std::string>& arguments);
ExitCode run_hand_show(const std::vector<std::string>& arguments);
ExitCode run_hand_reach(const std::vector<std::string>& arguments);
ExitCode run_hand_check(const std::vector<std::string>& arguments);
ExitCode run_hand_export(const std::vector<std::string>& arguments);
ExitCode run_hand_derive(const std::vector<std::string>& arguments);

}  // namespace graspfit::app
