#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "cli/command_table.hpp"
#include "commands/commands.hpp"
#include "commands/experiment_commands.hpp"
#include "graspfit/experiments/experiment_registry.hpp"
#include "graspfit/sweep/column_dictionary.hpp"
#include "graspfit/sweep/data_files.hpp"
#include "graspfit/sweep/experiment_config.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using sweep::Experiment;
using sweep::ExperimentConfig;

const char* const kUsage =
    "Usage: graspfit experiment COMMAND ... | --help\n"
    "\n"
    "Experiments: tables of results over sweeps of objects, hands and options of the planner.\n"
    "\n"
    "  graspfit experiment list            the experiments and their questions\n"
    "  graspfit experiment describe SLUG   axes, settings with their values, columns\n"
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

ExitCode run_list(const std::vector<std::string>& arguments) {
  const Command command = list_command();
  const Flags flags(command, arguments);
  if (is_help_printed(command, flags)) return kSuccess;
  const fs::path folder = sweep::config_folder();
  ExitCode code = kSuccess;
  for (const Experiment& experiment : experiments::all_experiments()) {
    try {
      const ExperimentConfig config =
          sweep::read_config(experiment, folder / (experiment.slug + ".json"));
      std::printf("%s: %zu cells\n  %s\n", experiment.slug.c_str(), config.sweep.num_cells(),
                  config.question.c_str());
    } catch (const base::Error& error) {
      // The other experiments are listed all the same.
      std::fprintf(stderr, "graspfit experiment list: %s: %s\n", experiment.slug.c_str(),
                   error.what());
      code = kBadInput;
    }
  }
  return code;
}

ExitCode run_columns(const std::vector<std::string>& arguments) {
  const Command command{"experiment columns", "SLUG",
                        "Prints every column of an experiment's tables with unit and meaning, as "
                        "JSON: what --publish\nwrites into SLUG.columns.json.\n",
                        option_group("Options"), ""};
  const std::optional<ExperimentCall> call = experiment_call(command, arguments);
  if (!call) return kSuccess;
  const ExperimentConfig config = load_experiment_config(call->experiment, call->flags);
  std::fputs(sweep::column_dictionary(call->experiment, config).c_str(), stdout);
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
                                                    {"describe", run_experiment_describe},
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
