#include "cli/command_table.hpp"

#include <algorithm>
#include <cstdio>

#include "graspfit/base/nearest_name.hpp"

namespace graspfit::app {
namespace {

/// Names as text: "list, show and check".
std::string names_text(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += names[i];
  }
  return text;
}

}  // namespace

const NamedCommand* find_command(std::span<const NamedCommand> commands, const std::string& name) {
  const auto found =
      std::find_if(commands.begin(), commands.end(),
                   [&](const NamedCommand& command) { return name == command.name; });
  return found == commands.end() ? nullptr : &*found;
}

ExitCode run_command(std::span<const NamedCommand> commands, const std::string& family,
                     const char* usage, const std::vector<std::string>& arguments) {
  std::vector<std::string> names;
  for (const NamedCommand& command : commands) names.emplace_back(command.name);
  const std::string there_are = "; there are " + names_text(names);
  if (arguments.empty()) {
    throw UsageError("no command given" + there_are + " (see " +
                     (family.empty() ? "" : family + ' ') + "--help)");
  }
  const std::string& name = arguments[0];
  if (const NamedCommand* const command = find_command(commands, name)) {
    return command->run({arguments.begin() + 1, arguments.end()});
  }
  if (name == "--help" || name == "-h" || name == "help") {
    std::fputs(usage, stdout);
    return kSuccess;
  }
  throw UsageError("unknown command \"" + name + '"' + there_are + base::did_you_mean(name, names));
}

}  // namespace graspfit::app
