#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "commands.hpp"
#include "graspfit/experiments/experiment_config.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/experiments/run_manifest.hpp"
#include "graspfit/experiments/sweep_runner.hpp"
#include "progress_bar.hpp"
#include "text_table.hpp"

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
    "\n"
    "graspfit experiment COMMAND --help lists a command's options with their defaults.\n";

const char* const kCommandNames = "list, describe and run";

po::options_description change_options() {
  po::options_description options = option_group("What of it");
  add_switch(options, "quick", "a few cells only, in seconds");
  add_repeatable_option(options, "set", "AXIS=A,B,...",
                        "other values for an axis, by their names or, for a plain setting, any; "
                        "the name of a setting makes a new axis; may be given several times");
  return options;
}

Command list_command() {
  return {"experiment list", "", "Lists the experiments.\n", option_group("Options"), ""};
}

Command describe_command() {
  Command command{"experiment describe", "SLUG",
                  "Shows an experiment's question, axes, settings and columns.\n", option_group(),
                  ""};
  command.options.add(change_options());
  return command;
}

Command run_command() {
  po::options_description how = option_group("How");
  add_option(how, "jobs", "J", "1", "cells at once; timings are honest with one");
  add_option(how, "out", "DIR", std::nullopt,
             "folder of the results; without it results/SLUG, with --quick results/SLUG_quick");
  add_switch(how, "publish",
             "afterwards copy the tables into notebooks-data; refused for --quick, --set, missing "
             "data and sources that are not committed");
  add_switch(how, "quiet", "no progress bar and no summary");
  Command command{"experiment run", "SLUG",
                  "Runs an experiment: SLUG.csv, SLUG.timing.csv and SLUG.manifest.json. Cells "
                  "that are finished are\nkept on disk at once; after an interruption the same "
                  "command does the rest. Results are\nthe same bytes for any --jobs.\n",
                  option_group(),
                  "Meshes and hands that are not part of the repository are looked for in "
                  "$GRASPFIT_DATA; cells\nthat lack theirs are skipped, and the rows say so.\n"};
  command.options.add(change_options()).add(how);
  return command;
}

ExperimentConfig load_config(const Experiment& experiment, const Flags& flags) {
  experiments::ConfigRequest request;
  request.is_quick = flags.has("quick");
  for (const std::string& text : flags.texts("set")) {
    request.changes.push_back(experiments::parse_axis_change(text));
  }
  const fs::path file = experiments::config_folder() / (experiment.slug + ".json");
  return experiments::read_config(experiment, file, request);
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
  if (flags.wants_help()) {
    std::fputs(help_text(command).c_str(), stdout);
    return kSuccess;
  }
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
  if (flags.wants_help()) {
    std::fputs(help_text(command).c_str(), stdout);
    return kSuccess;
  }
  const Experiment& experiment = experiments::find_experiment(flags.positional());
  const ExperimentConfig config = load_config(experiment, flags);
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
  for (const auto& [table, columns] : {std::pair("details.csv after the axes", &experiment.details),
                                       std::pair("summary.csv", &experiment.summary)}) {
    if (columns->empty()) continue;
    std::printf("\nColumns of %s.%s:\n%s", experiment.slug.c_str(), table,
                columns_text(*columns).c_str());
  }
  for (const experiments::SummaryTable& summary : experiment.further_summaries) {
    std::printf("\nColumns of %s.%s.csv:\n%s", experiment.slug.c_str(), summary.name.c_str(),
                columns_text(summary.columns).c_str());
  }
  std::vector<experiments::Column> settings = experiment.settings;
  const auto& common = experiments::planning_setting_names();
  settings.insert(settings.end(), common.begin(), common.end());
  std::printf("\nSettings, each of which can be an axis:\n%s", columns_text(settings).c_str());
  return kSuccess;
}

std::string command_text(const std::vector<std::string>& arguments) {
  std::string text = "graspfit experiment run";
  for (const std::string& argument : arguments) text += ' ' + argument;
  return text;
}

/// "12 of 110 cells, 0.31 per s, 5 min left": the rate is of this run alone.
std::string progress_text(const experiments::RunProgress& progress,
                          std::chrono::steady_clock::time_point start) {
  const std::size_t reached = progress.num_done + progress.num_skipped;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  const double rate = static_cast<double>(reached - progress.num_resumed) / elapsed.count();
  constexpr double kSecondsPerMinute = 60.0;
  const double minutes =
      static_cast<double>(progress.num_cells - reached) / rate / kSecondsPerMinute;
  return std::to_string(reached) + " of " + std::to_string(progress.num_cells) + " cells, " +
         fixed_decimal(rate, 2) + " per s, " + fixed_decimal(minutes, 1) + " min left";
}

ExitCode run_run(const std::vector<std::string>& arguments) {
  const Command command = run_command();
  const Flags flags(command, arguments);
  if (flags.wants_help()) {
    std::fputs(help_text(command).c_str(), stdout);
    return kSuccess;
  }
  const Experiment& experiment = experiments::find_experiment(flags.positional());
  const ExperimentConfig config = load_config(experiment, flags);
  const fs::path sources = experiments::source_folder();
  if (flags.has("publish")) experiments::require_publishable(config, sources);

  experiments::RunOptions options;
  options.jobs = flags.integer("jobs");
  options.folder = flags.has("out") ? fs::path(flags.text("out"))
                                    : fs::path("results") /
                                          (experiment.slug + (config.is_quick ? "_quick" : ""));
  experiments::RunManifest manifest;
  manifest.command = command_text(arguments);
  manifest.versions = version_rows();

  ProgressBar bar(!flags.has("quiet"));
  const auto start = std::chrono::steady_clock::now();
  const experiments::RunProgress done = experiments::run_sweep(
      experiment, config, manifest, options, [&](const experiments::RunProgress& progress) {
        const std::size_t reached = progress.num_done + progress.num_skipped;
        bar.show(static_cast<std::int64_t>(reached), static_cast<std::int64_t>(progress.num_cells),
                 progress_text(progress, start));
      });
  bar.clear();
  if (flags.has("publish")) {
    experiments::publish(experiment, config, options.folder, sources, sources / "notebooks-data");
  }
  if (!flags.has("quiet")) {
    std::printf("%zu cells: %zu finished (%zu earlier), %zu of these failed, %zu skipped\n",
                done.num_cells, done.num_done, done.num_resumed, done.num_failed, done.num_skipped);
    std::printf("written to %s\n", options.folder.c_str());
    if (flags.has("publish")) std::printf("published in %s\n", "notebooks-data");
  }
  return kSuccess;
}

using Run = ExitCode (*)(const std::vector<std::string>&);
constexpr std::array<std::pair<const char*, Run>, 3> kCommands = {
    {{"list", run_list}, {"describe", run_describe}, {"run", run_run}}};

}  // namespace

bool is_experiment_command(const std::string& name) {
  for (const auto& [command, run] : kCommands) {
    if (name == command) return true;
  }
  return false;
}

ExitCode run_experiment(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    throw UsageError(std::string("no command given; there are ") + kCommandNames +
                     " (see experiment --help)");
  }
  for (const auto& [name, run] : kCommands) {
    if (arguments[0] == name) return run({arguments.begin() + 1, arguments.end()});
  }
  if (arguments[0] == "--help" || arguments[0] == "-h" || arguments[0] == "help") {
    std::fputs(kUsage, stdout);
    return kSuccess;
  }
  throw UsageError("unknown command \"" + arguments[0] + "\"; there are " + kCommandNames);
}

}  // namespace graspfit::app
