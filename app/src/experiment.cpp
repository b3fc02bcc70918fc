#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "command_table.hpp"
#include "commands.hpp"
#include "experiment_commands.hpp"
#include "graspfit/experiments/column_dictionary.hpp"
#include "graspfit/experiments/experiment_config.hpp"
#include "graspfit/experiments/planning_settings.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using experiments::Experiment;
using experiments::ExperimentConfig;

const char* const kUsage =
    "Usage: graspfit experiment COMMAND ... | --help\n"
    "\n"
    "Experiments: tables of results over sweeps of objects, hands and options of the planner.\n"
    "\n"
    "  graspfit experiment list            the experiments and their questions\n"
    "  graspfit experiment describe SLUG   axes, settings and columns of one\n"
    "  graspfit experiment run SLUG        runs it, or what is left of it\n"
    "  graspfit experiment status SLUG     how far a run and its shards are\n"
    "  graspfit experiment merge SLUG      makes one run of all shards\n"
    "  graspfit experiment verify SLUG     compares a run with published results\n"
    "  graspfit experiment columns SLUG    its columns with units, as JSON\n"
    "  graspfit experiment schema          the JSON Schema of configurations\n"
    "\n"
    "graspfit experiment COMMAND --help lists a command's options with their defaults.\n";

Command list_command() {
  return {"experiment list", "", "Lists the experiments.\n", option_group("Options"), ""};
}

Command describe_command() {
  Command command{"experiment describe", "SLUG",
                  "Shows an experiment's question, axes, settings and columns.\n", option_group(),
                  ""};
  command.options.add(config_change_options());
  return command;
}

std::string columns_text(const std::vector<experiments::Column>& columns) {
  constexpr std::size_t kNameWidth = 27;
  constexpr std::size_t kUnitWidth = 5;
  std::string text;
  for (const experiments::Column& column : columns) {
    std::string line = "  " + column.name;
    line.resize(std::max(line.size() + 1, kNameWidth), ' ');
    line += column.unit.empty() ? "-" : column.unit;
    line.resize(std::max(line.size() + 1, kNameWidth + kUnitWidth), ' ');
    text += line + column.meaning + '\n';
  }
  return text;
}

ExitCode run_list(const std::vector<std::string>& arguments) {
  const Command command = list_command();
  const Flags flags(command, arguments);
  if (is_help_printed(command, flags)) return kSuccess;
  for (const Experiment& experiment : experiments::all_experiments()) {
    const fs::path file = experiments::config_folder() / (experiment.slug + ".json");
    const ExperimentConfig config = experiments::read_config(experiment, file);
    std::printf("%s: %zu cells\n  %s\n", experiment.slug.c_str(), config.sweep.num_cells(),
                config.question.c_str());
  }
  return kSuccess;
}

ExitCode run_describe(const std::vector<std::string>& arguments) {
  const Command command = describe_command();
  const Flags flags(command, arguments);
  if (is_help_printed(command, flags)) return kSuccess;
  const Experiment& experiment = experiments::find_experiment(flags.positional());
  const ExperimentConfig config = load_experiment_config(experiment, flags);
  std::printf("%s\n\nquestion  %s\ncell      %s\nconfig    %s\n\n%zu cells:\n",
              experiment.slug.c_str(), config.question.c_str(), config.cell.c_str(),
              config.file.c_str(), config.sweep.num_cells());
  for (const experiments::Axis& axis : config.sweep.axes) {
    std::printf("  %s:", axis.name.c_str());
    for (const experiments::AxisValue& value : axis.values) {
      std::printf(" %s", value.label.c_str());
    }
    std::printf("\n");
  }
  std::printf("  settings of all: %s\n", config.sweep.settings.c_str());
  std::printf("\nColumns of %s.csv after the axes, cell_seed, status and reason:\n%s",
              experiment.slug.c_str(), columns_text(experiment.columns).c_str());
  std::printf("\nColumns of %s.timing.csv after the axes, wall_s and cpu_s:\n%s",
              experiment.slug.c_str(), columns_text(experiment.timings).c_str());
  if (!experiment.details.empty()) {
    std::printf("\nColumns of %s.details.csv after the axes:\n%s", experiment.slug.c_str(),
                columns_text(experiment.details).c_str());
  }
  for (const experiments::SummaryTable& summary : experiment.summaries) {
    std::printf("\nColumns of %s.%s.csv:\n%s", experiment.slug.c_str(), summary.name.c_str(),
                columns_text(summary.columns).c_str());
  }
  std::vector<experiments::Column> settings = experiment.settings;
  const auto& common = experiments::planning_setting_names();
  settings.insert(settings.end(), common.begin(), common.end());
  std::printf("\nSettings, each of which can be an axis:\n%s", columns_text(settings).c_str());
  return kSuccess;
}

ExitCode run_columns(const std::vector<std::string>& arguments) {
  const Command command{"experiment columns", "SLUG",
                        "Prints every column of an experiment's tables with unit and meaning, as "
                        "JSON: what --publish\nwrites into SLUG.columns.json.\n",
                        option_group("Options"), ""};
  const Flags flags(command, arguments);
  if (is_help_printed(command, flags)) return kSuccess;
  const Experiment& experiment = experiments::find_experiment(flags.positional());
  const fs::path file = experiments::config_folder() / (experiment.slug + ".json");
  std::fputs(experiments::column_dictionary(experiment, experiments::read_config(experiment, file))
                 .c_str(),
             stdout);
  return kSuccess;
}

ExitCode run_schema(const std::vector<std::string>& arguments) {
  const Command command{
      "experiment schema", "",
      "Prints the JSON Schema of configurations: experiments/config.schema.json.\n",
      option_group("Options"), ""};
  const Flags flags(command, arguments);
  if (is_help_printed(command, flags)) return kSuccess;
  std::fputs(experiments::config_schema().c_str(), stdout);
  return kSuccess;
}

constexpr std::array<NamedCommand, 8> kCommands = {{{"list", run_list},
                                                    {"describe", run_describe},
                                                    {"run", run_experiment_run},
                                                    {"status", run_experiment_status},
                                                    {"merge", run_experiment_merge},
                                                    {"verify", run_experiment_verify},
                                                    {"columns", run_columns},
                                                    {"schema", run_schema}}};

}  // namespace

bool is_experiment_command(const std::string& name) {
  return find_command(kCommands, name) != nullptr;
}

ExitCode run_experiment(const std::vector<std::string>& arguments) {
  return run_command(kCommands, "experiment", kUsage, arguments);
}

}  // namespace graspfit::app
