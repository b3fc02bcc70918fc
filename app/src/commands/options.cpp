#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "cli/command_line.hpp"
#include "commands/commands.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/planner_presets.hpp"
#include "input/planner_flags.hpp"

namespace graspfit::app {
namespace {

using grasp::OptionKind;
using grasp::PlannerOption;

constexpr const char* kHead =
    "# Options of the planner\n"
    "\n"
    "Written by `graspfit options` from the rows of `grasp/src/rows/option_rows.hpp`. By one name "
    "an "
    "option is a flag of\n"
    "`graspfit plan` and a setting of experiments; in grasp files it stands under "
    "`/planner/options/` in SI units.\n"
    "[P] is stated by the paper, [R] a reading of what it leaves open, by its number in "
    "[readings.md](readings.md).\n";

Command options_command() {
  auto options = option_group("Options");
  add_option(options, "schema", "FILE", std::nullopt,
             "print instead this schema of grasp files, with the options as they are now");
  return {"options", "",
          "Prints all options of the planner as a Markdown page: names, defaults, units, ranges, "
          "meanings.\n",
          std::move(options), ""};
}

/// A cell of a Markdown table, with | escaped, which separates cells.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

std::string values_text(const PlannerOption& option) {
  if (option.name == "palm") return "flags --palm and --no-palm; setting true|false";
  if (option.name == "weak-thickness-mm") return "> 0; none: flag --no-weak, setting 0";
  switch (option.kind) {
    case OptionKind::Number:
      return option.range.text();
    case OptionKind::Integer:
      return "integer " + option.range.text();
    case OptionKind::YesNo:
      return std::string(option.yes) + '|' + std::string(option.no);
    case OptionKind::Choice:
      return option.choices_text();
    case OptionKind::Names:
      return "names";
    case OptionKind::Direction:
      return "x, y, z";
  }
  return "";
}

std::string default_text(const PlannerOption& option) {
  if (option.fallback.empty()) return "–";
  if (option.kind == OptionKind::YesNo) {
    return std::string(option.fallback == "true" ? option.yes : option.no);
  }
  const bool has_unit = option.is_number() && option.unit != "1";
  return option.fallback + (has_unit ? ' ' + std::string(option.unit) : "");
}

std::string meaning_text(const PlannerOption& option) {
  std::string text(option.meaning);
  if (!option.is_setting) text += "; not a setting of experiments";
  return text + option.source_text();
}

std::string preset_rows() {
  std::string text = "\n## Presets\n\n| `--preset` | is | sets |\n| --- | --- | --- |\n";
  for (const grasp::PlannerPreset& preset : grasp::planner_presets()) {
    text += "| `" + std::string(preset.name) + "` | " + std::string(preset.meaning) + " | " +
            preset_values_text(preset) + " |\n";
  }
  return text;
}

std::string group_rows(std::string_view group) {
  std::string text = "\n## " + std::string(group) +
                     "\n\n| name | default | may be | in files | is |\n"
                     "| --- | --- | --- | --- | --- |\n";
  for (const PlannerOption& option : grasp::planner_option_table()) {
    if (option.group != group) continue;
    text += "| `" + std::string(option.name) + "` | " + cell(default_text(option)) + " | " +
            cell(values_text(option)) + " | `" + option.path + "` | " + cell(meaning_text(option)) +
            " |\n";
  }
  return text;
}

}  // namespace

ExitCode run_options(const std::vector<std::string>& arguments) {
  const Command command = options_command();
  const Flags flags(command, arguments);
  if (flags.wants_help()) {
    std::fputs(help_text(command).c_str(), stdout);
    return kSuccess;
  }
  if (flags.has("schema")) {
    const std::string& file = flags.text("schema");
    std::fputs(grasp::with_option_schema(base::read_file(file), file).c_str(), stdout);
    return kSuccess;
  }
  std::string page = kHead + preset_rows();
  for (const std::string_view group :
       {grasp::option_group::kRequest, grasp::option_group::kSearch, grasp::option_group::kDistinct,
        grasp::option_group::kTargets, grasp::option_group::kScores, grasp::option_group::kContacts,
        grasp::option_group::kForces, grasp::option_group::kMeasure}) {
    page += group_rows(group);
  }
  std::fputs(page.c_str(), stdout);
  return kSuccess;
}

}  // namespace graspfit::app
