#include <cstdio>
#include <string>
#include <vector>

#include "commands/commands.hpp"
#include "commands/experiment_commands.hpp"
#include "commands/sweep_runs.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/experiments/experiment_registry.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/sweep/data_files.hpp"
#include "graspfit/sweep/run_manifest.hpp"
#include "graspfit/sweep/sweep_runner.hpp"
#include "graspfit/sweep/sweep_shards.hpp"
#include "graspfit/sweep/table_comparison.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using sweep::Experiment;
using sweep::ExperimentConfig;

const char* const kQuickMeaning = "a few cells only, in seconds";

/// Adds --out and, for commands that only read results, --quick, which chooses the results of a
/// quick run.
void add_results_flags(po::options_description& options, bool has_quick) {
  add_option(options, "out", "DIR", std::nullopt,
             "folder of the results; without it results/SLUG, with --quick results/SLUG_quick");
  if (has_quick) add_switch(options, "quick", std::string("of a run with ") + kQuickMeaning);
}

/// Adds --publish and --quiet, for commands that write tables.
void add_table_flags(po::options_description& options, const std::string& quiet_meaning) {
  add_switch(
      options, "publish",
      "afterwards copy the tables into notebooks-data; refused for --quick, --set, --object, "
      "missing data and sources that are not committed");
  add_switch(options, "quiet", quiet_meaning);
}

Command run_command() {
  po::options_description how = option_group("How");
  add_option(how, "jobs", "J", "1", "cells at once; timings are honest with one");
  add_option(how, "shard", "I/N", std::nullopt,
             "only every N-th cell, from the I-th on, into DIR/shards/I-of-N; then merge");
  add_results_flags(how, false);
  add_table_flags(how, "no progress bar and no summary");
  Command command{
      "experiment run", "SLUG",
      "Runs an experiment: SLUG.csv, SLUG.timing.csv and SLUG.manifest.json. Cells "
      "that are finished are\nkept on disk at once; after an interruption the same "
      "command does the rest. Results are\nthe same bytes for any --jobs and any shards.\n",
      option_group(),
      "Meshes and hands that are not part of the repository are looked for in $GRASPFIT_DATA, a "
      "few "
      "meshes\nalso in $GRASPFIT_PACKAGED_MESHES, libcgal-demo's. Without that data folder objects "
      "that need it\nare left out, others come instead, and one line says so; \"describe\" says "
      "what "
      "needs which data.\nWhere there is one, cells that lack theirs are skipped, and the rows say "
      "so. "
      "If all are, it is\nan error.\n"};
  command.options.add(config_change_options()).add(how);
  return command;
}

Command status_command() {
  po::options_description options = option_group("Options");
  add_results_flags(options, true);
  return {"experiment status", "SLUG",
          "Says how many cells of a run and of its shards are done, failed and left, and how fast "
          "those\nare that are running. Does not disturb them.\n",
          options, ""};
}

Command merge_command() {
  po::options_description how = option_group("How");
  add_results_flags(how, false);
  add_table_flags(how, "no summary");
  Command command{
      "experiment merge", "SLUG",
      "Takes the cells of all shards in DIR/shards over into DIR and writes the tables: the same\n"
      "bytes as one run's. Refused while cells are missing or shards are running.\n",
      option_group(), ""};
  command.options.add(config_change_options()).add(how);
  return command;
}

Command verify_command() {
  const sweep::ComparisonOptions defaults;
  po::options_description options = option_group("Options");
  add_results_flags(options, true);
  add_option(options, "against", "DIR", std::nullopt,
             "folder of the published tables; without it notebooks-data");
  add_option(options, "relative", "NUMBER", base::shortest_decimal(defaults.relative),
             "largest difference of two numbers over the larger magnitude");
  add_option(options, "absolute", "NUMBER", base::shortest_decimal(defaults.absolute),
             "numbers up to this magnitude are zeros but for rounding");
  return {"experiment verify", "SLUG",
          "Compares the tables of a run, perhaps with --set of fewer cells, with published ones, "
          "perhaps\nof another machine: rows of the same labels, numbers within a tolerance, all "
          "else exactly.\nTimings are not compared. Exit code 4 if fields differ or rows of the "
          "run's cells are missing;\nwhich, is printed.\n",
          options, ""};
}

fs::path results_folder(const Flags& flags) {
  if (flags.has("out")) return flags.text("out");
  return fs::path("results") / (flags.positional() + (flags.has("quick") ? "_quick" : ""));
}

fs::path published_folder() { return sweep::source_folder() / "notebooks-data"; }

/// Prints the result of a comparison with a published table.
void print_comparison(const sweep::PublishedComparison& table) {
  constexpr std::size_t kMostShown = 20;
  const sweep::TableComparison& found = table.comparison;
  std::printf("%s: %zu rows compared", table.file.c_str(), found.num_rows);
  if (found.num_not_ours > 0) std::printf(" (%zu published ones not)", found.num_not_ours);
  if (found.are_same_bytes) {
    std::printf(", the same bytes\n");
    return;
  }
  std::printf(", %zu fields differ; the others by at most %.1e\n", found.differences.size(),
              found.largest_relative);
  for (std::size_t i = 0; i < found.differences.size() && i < kMostShown; ++i) {
    const sweep::FieldDifference& field = found.differences[i];
    std::printf("  %s: %s is \"%s\", published \"%s\"\n", field.row.c_str(), field.column.c_str(),
                field.ours.c_str(), field.theirs.c_str());
  }
  if (found.differences.size() > kMostShown) {
    std::printf("  and %zu more\n", found.differences.size() - kMostShown);
  }
  if (found.missing_rows.empty()) return;
  std::printf("  %zu published rows of the run's cells are missing\n", found.missing_rows.size());
  for (std::size_t i = 0; i < found.missing_rows.size() && i < kMostShown; ++i) {
    std::printf("  %s: is missing\n", found.missing_rows[i].c_str());
  }
}

/// Prints which values a run leaves out because their data is missing, if any.
void print_left_out(const ExperimentConfig& config) {
  if (config.left_out.empty()) return;
  std::fprintf(
      stderr,
      "graspfit experiment: note: there is no data folder %s (GRASPFIT_DATA): %s; this run "
      "is never published\n",
      sweep::data_folder().c_str(), config.left_out.c_str());
}

sweep::ConfigRequest config_request(const Flags& flags) {
  sweep::ConfigRequest request;
  request.is_quick = flags.has("quick");
  for (const std::string& text : flags.texts("set")) {
    request.changes.push_back(sweep::parse_axis_change(text));
  }
  for (const std::string& file : flags.texts("object")) request.object_files.emplace_back(file);
  if (flags.has("longest")) {
    if (request.object_files.empty()) throw UsageError("--longest means nothing without --object");
    request.object_longest = flags.number("longest", base::above(0));
  }
  return request;
}

void require_shipped_config_to_publish(const Flags& flags) {
  if (flags.has("publish") && flags.has("config")) {
    throw UsageError("--publish means nothing with --config: only shipped ones are published");
  }
}

fs::path config_file(const Experiment& experiment, const Flags& flags) {
  if (flags.has("config")) return flags.text("config");
  return sweep::config_folder() / (experiment.slug + ".json");
}

}  // namespace

po::options_description config_change_options() {
  po::options_description options = option_group("What of it");
  add_option(options, "config", "FILE", std::nullopt,
             "a configuration of your own instead of the shipped one, in the same form "
             "(experiment schema); never published");
  add_switch(options, "quick", kQuickMeaning);
  add_repeatable_option(options, "set", "AXIS=A,B,...",
                        "other values for an axis, by their names or, for a plain setting, any; "
                        "the name of a setting makes a new axis; may be given several times");
  add_repeatable_option(options, "object", "FILE",
                        "a mesh instead of the values of the axis object, or beside those that "
                        "--set object=... picks; may be given again for further ones");
  add_option(options, "longest", "LENGTH_M", std::nullopt,
             "of each --object: scaled so that its bounding box's longest edge is this long [m]; "
             "without it, and where the experiment sets no sizes, files are in meters");
  return options;
}

ExperimentConfig load_experiment_config(const Experiment& experiment, const Flags& flags) {
  return sweep::read_config(experiment, config_file(experiment, flags), config_request(flags));
}

ExperimentConfig load_config_to_run(const Experiment& experiment, const Flags& flags) {
  sweep::ConfigRequest request = config_request(flags);
  std::error_code error;
  request.leaves_out_missing_data = !fs::is_directory(sweep::data_folder(), error);
  return sweep::read_config(experiment, config_file(experiment, flags), request);
}

bool is_help_printed(const Command& command, const Flags& flags) {
  if (flags.wants_help()) std::fputs(help_text(command).c_str(), stdout);
  return flags.wants_help();
}

std::optional<ExperimentCall> experiment_call(const Command& command,
                                              const std::vector<std::string>& arguments) {
  Flags flags(command, arguments);
  if (is_help_printed(command, flags)) return std::nullopt;
  const Experiment& experiment = experiments::find_experiment(flags.positional());
  return ExperimentCall{std::move(flags), experiment};
}

ExitCode run_experiment_run(const std::vector<std::string>& arguments) {
  const Command command = run_command();
  const std::optional<ExperimentCall> call = experiment_call(command, arguments);
  if (!call) return kSuccess;
  const auto& [flags, experiment] = *call;
  if (flags.has("publish") && flags.has("shard")) {
    throw UsageError("--publish means nothing with --shard; merge has it");
  }
  require_shipped_config_to_publish(flags);
  const ExperimentConfig config = load_config_to_run(experiment, flags);
  const fs::path sources = sweep::source_folder();
  if (flags.has("publish")) sweep::require_publishable(config, sources);

  sweep::RunOptions options;
  options.jobs = flags.integer("jobs", base::between(1, sweep::RunOptions::kMostJobs));
  options.folder = results_folder(flags);
  if (flags.has("shard")) options.shard = sweep::parse_shard(flags.text("shard"));
  print_left_out(config);
  const sweep::RunProgress done = run_with_progress(
      experiment, config, begun_manifest("experiment run", arguments), options, flags.has("quiet"));
  if (flags.has("publish")) {
    sweep::publish(experiment, config, options.folder, sources, published_folder());
  }
  if (!flags.has("quiet")) {
    print_run(done);
    const fs::path folder =
        options.shard ? sweep::shard_folder(options.folder, *options.shard) : options.folder;
    std::printf("written to %s\n", folder.c_str());
    if (flags.has("publish")) std::printf("published in %s\n", "notebooks-data");
  }
  return kSuccess;
}

ExitCode run_experiment_status(const std::vector<std::string>& arguments) {
  const Command command = status_command();
  const std::optional<ExperimentCall> call = experiment_call(command, arguments);
  if (!call) return kSuccess;
  const auto& [flags, experiment] = *call;
  print_status(sweep::sweep_status(experiment.slug, results_folder(flags)));
  return kSuccess;
}

ExitCode run_experiment_merge(const std::vector<std::string>& arguments) {
  const Command command = merge_command();
  const std::optional<ExperimentCall> call = experiment_call(command, arguments);
  if (!call) return kSuccess;
  const auto& [flags, experiment] = *call;
  require_shipped_config_to_publish(flags);
  const ExperimentConfig config = load_config_to_run(experiment, flags);
  const fs::path sources = sweep::source_folder();
  if (flags.has("publish")) sweep::require_publishable(config, sources);
  const fs::path folder = results_folder(flags);
  const sweep::RunProgress done = sweep::merge_shards(
      experiment, config, begun_manifest("experiment merge", arguments), folder);
  print_left_out(config);
  if (flags.has("publish")) {
    sweep::publish(experiment, config, folder, sources, published_folder());
  }
  if (!flags.has("quiet")) {
    print_run(done);
    std::printf("written to %s\n", folder.c_str());
    if (flags.has("publish")) std::printf("published in notebooks-data\n");
  }
  return kSuccess;
}

ExitCode run_experiment_verify(const std::vector<std::string>& arguments) {
  const Command command = verify_command();
  const std::optional<ExperimentCall> call = experiment_call(command, arguments);
  if (!call) return kSuccess;
  const auto& [flags, experiment] = *call;
  const fs::path published =
      flags.has("against") ? fs::path(flags.text("against")) : published_folder();
  const sweep::ComparisonOptions options{flags.number("relative", base::at_least(0)),
                                         flags.number("absolute", base::at_least(0))};
  const fs::path folder = results_folder(flags);
  const std::string otherwise = sweep::published_otherwise(experiment, folder, published);
  // This line is printed first, since it may explain differences of the tables.
  if (!otherwise.empty()) std::printf("%s: %s\n", published.c_str(), otherwise.c_str());
  bool is_equal = true;
  for (const sweep::PublishedComparison& table :
       sweep::compare_with_published(experiment, folder, published, options)) {
    print_comparison(table);
    is_equal = is_equal && table.comparison.is_equal();
  }
  return is_equal ? kSuccess : kDiffers;
}

}  // namespace graspfit::app
