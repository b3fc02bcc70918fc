#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "cli/command_line.hpp"
#include "cli/command_table.hpp"
#include "commands/commands.hpp"
#include "commands/experiment_commands.hpp"
#include "commands/sweep_runs.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/experiments/grasp_dataset.hpp"
#include "input/hand_loading.hpp"
#include "input/object_loading.hpp"
#include "output/dataset_archive.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using experiments::DatasetRequest;
using sweep::ExperimentConfig;

const char* const kDatasetUsage =
    "Usage: graspfit dataset COMMAND DIR ... | --help\n"
    "\n"
    "Data sets of grasps: many objects, some hands, a few tested grasps of each.\n"
    "\n"
    "  graspfit dataset run DIR      makes one in the folder DIR, or does what is left of it\n"
    "  graspfit dataset status DIR   how far it and its shards are\n"
    "  graspfit dataset merge DIR    makes one of all shards\n"
    "  graspfit dataset pack DIR     an archive of it, with its hash on its card\n"
    "\n"
    "graspfit dataset COMMAND --help lists a command's options with their defaults.\n";

/// Options that say what the data set is; without --objects none of them may be given.
constexpr std::array<const char*, 10> kRequestFlags = {
    "hand",     "longest", "mesh-unit", "preset",    "grasps",
    "protocol", "margins", "seed",      "rest-pose", "set"};

Command run_command_of_dataset() {
  const DatasetRequest defaults;
  po::options_description what = option_group("What is in it");
  add_repeatable_option(what, "objects", "SOURCE",
                        "a mesh, a folder of meshes, or a list of them: a line each (.txt) or a "
                        "table (.csv) with columns file and perhaps name, longest_m, "
                        "meters_per_unit, license; may be given several times. Without it what "
                        "stands in DIR goes on");
  add_repeatable_option(what, "hand", "NAME|FILE",
                        "a hand as graspfit plan takes it; may be given several times");
  add_option(what, "longest", "A,B,... [m]", std::nullopt,
             "scale objects so that their bounding box's longest edge is this long, once for each "
             "length; without it they keep their sizes");
  add_option(what, "mesh-unit", "m|cm|mm|in", std::nullopt,
             "unit of the numbers in the meshes; without it meters");
  add_option(what, "rest-pose", "RANK", std::nullopt,
             "lay objects down on a table, in the pose of this rank; without it free space");
  add_option(what, "preset", "NAME", defaults.preset, "of the planner, as of graspfit plan");
  add_option(what, "grasps", "N", std::to_string(defaults.grasps),
             "of each object with each hand, at most");
  add_option(what, "protocol", "NAME", defaults.protocol,
             "hold test of every grasp (graspfit hold --help), or none");
  add_option(what, "margins", "N", std::to_string(defaults.margins),
             "grasps of each object and hand, the best, whose smallest failing loads are found");
  add_option(what, "seed", "INTEGER", std::to_string(defaults.seed), "of all random numbers");
  add_repeatable_option(what, "set", "NAME=VALUE",
                        "another setting, such as resolution=48: see graspfit experiment describe "
                        "hold_default; may be given several times");
  po::options_description how = option_group("How");
  add_option(how, "jobs", "J", "1", "objects and hands at once; timings are honest with one");
  add_option(how, "shard", "I/N", std::nullopt,
             "only every N-th, from the I-th on, into DIR/shards/I-of-N; then merge");
  add_switch(how, "request-only", "write the request into DIR, for shards to come, and no more");
  add_switch(how, "quiet", "no progress bar and no summary");
  Command command{
      "dataset run", "DIR",
      "Plans and tests grasps of many objects. DIR gets an index (dataset.csv), a row per grasp\n"
      "(dataset.details.csv), grasp files (cells/), arrays for NumPy (arrays/) and a card "
      "(CARD.md).\nA mesh that cannot be used is a row with its reason. What is finished is kept "
      "on "
      "disk at\nonce: after an interruption the same command, or graspfit dataset run DIR, does "
      "the "
      "rest.\n",
      option_group(),
      "Shards may run on several machines that share DIR: a call with --objects, perhaps with "
      "--request-only,\nwrites the request; others need DIR and --shard alone.\n"};
  command.options.add(what).add(how);
  return command;
}

Command merge_command_of_dataset() {
  po::options_description options = option_group("Options");
  add_switch(options, "quiet", "no summary");
  return {"dataset merge", "DIR",
          "Takes over what the shards in DIR/shards have made, and writes index, arrays and card: "
          "the same\nbytes as one run's. Refused while cells are missing or shards are running.\n",
          options, ""};
}

Command status_command_of_dataset() {
  return {"dataset status", "DIR",
          "Says how much of a data set and of its shards is done, failed and left, and how fast "
          "those are\nthat are running. Does not disturb them.\n",
          option_group("Options"), ""};
}

Command pack_command_of_dataset() {
  po::options_description options = option_group("Options");
  add_option(options, "archive", "FILE", std::nullopt,
             "the archive (.tar.gz); without it DIR.tar.gz beside DIR");
  return {"dataset pack", "DIR",
          "Packs a finished data set: index, details, configuration, manifest, arrays, grasp files "
          "and card.\nThe archive's SHA-256 is printed and stands in FILE.card.md, the card with "
          "what there is to know\nof the archive. The same bytes for the same data set.\n",
          options, ""};
}

fs::path config_file(const fs::path& folder) { return folder / "dataset.config.json"; }

std::vector<std::pair<std::string, std::string>> further_settings(const Flags& flags) {
  std::vector<std::pair<std::string, std::string>> settings;
  for (const std::string& text : flags.texts("set")) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
      throw UsageError("--set \"" + text + "\" is not NAME=VALUE");
    }
    settings.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  if (flags.has("rest-pose")) {
    settings.emplace_back("rest_pose",
                          std::to_string(flags.integer("rest-pose", base::at_least(1))));
  }
  return settings;
}

DatasetRequest request_of(const Flags& flags) {
  DatasetRequest request;
  std::vector<fs::path> sources;
  for (const std::string& source : flags.texts("objects")) sources.emplace_back(source);
  request.hands = flags.texts("hand");
  if (request.hands.empty()) throw UsageError("no --hand given");
  if (flags.has("longest")) {
    if (flags.has("mesh-unit")) throw UsageError("--mesh-unit and --longest exclude each other");
    request.sizes = flags.numbers("longest");
    for (const double size : request.sizes) {
      if (!(size > 0.0)) throw UsageError("--longest: lengths must be > 0");
    }
  }
  if (flags.has("mesh-unit")) request.meters_per_unit = meters_per(flags, "mesh-unit");
  request.preset = flags.text("preset");
  request.grasps = flags.integer("grasps", base::at_least(1));
  request.protocol = flags.text("protocol");
  request.margins = flags.integer("margins", base::at_least(0));
  request.seed = flags.unsigned_integer("seed");
  request.settings = further_settings(flags);
  for (const std::string& hand : request.hands) {
    warn_of_findings("dataset run", load_hand(hand));  // a hand that cannot be used is said at once
  }
  request.objects = experiments::dataset_objects(sources);
  return request;
}

ExperimentConfig read_request(const fs::path& folder) {
  return sweep::read_config(experiments::dataset_experiment(), config_file(folder));
}

/// Writes the request into the folder, where none or the same one stands, and reads it.
ExperimentConfig begin(const fs::path& folder, const std::string& text) {
  const fs::path file = config_file(folder);
  std::error_code error;
  if (fs::exists(file, error)) {
    if (base::read_file(file) != text) {
      throw base::InvalidInput(file.string() +
                               ": is of another request; give another DIR, or go on with that one "
                               "by leaving --objects out");
    }
    return read_request(folder);
  }
  const bool is_new = !fs::exists(folder, error);
  fs::create_directories(folder, error);
  if (error) throw base::IoError(folder.string() + ": " + error.message());
  base::write_file_atomically(file, text);
  try {
    return read_request(folder);
  } catch (const base::Error&) {
    fs::remove(file, error);
    if (is_new) fs::remove(folder, error);
    throw;
  }
}

ExperimentConfig requested(const Flags& flags, const fs::path& folder) {
  if (flags.has("objects")) {
    return begin(folder, experiments::dataset_config(request_of(flags)));
  }
  for (const char* const flag : kRequestFlags) {
    const bool is_given = flags.has(flag) && !flags.is_default(flag);
    if (is_given) throw UsageError(std::string("--") + flag + " means nothing without --objects");
  }
  std::error_code error;
  if (!fs::exists(config_file(folder), error)) {
    throw UsageError("no --objects given, and " + folder.string() + " holds no data set");
  }
  return read_request(folder);
}

void finish(const fs::path& folder, const ExperimentConfig& config, const sweep::RunProgress& done,
            bool is_quiet) {
  const experiments::DatasetFiles files = experiments::write_dataset_files(folder, config);
  if (is_quiet) return;
  print_run(done);
  std::printf("%zu files of arrays\nwritten to %s\n", files.arrays.size(), folder.c_str());
}

ExitCode run_dataset_run(const std::vector<std::string>& arguments) {
  const Command command = run_command_of_dataset();
  const Flags flags(command, arguments);
  if (is_help_printed(command, flags)) return kSuccess;
  sweep::RunOptions options;
  options.folder = flags.positional();
  options.jobs = flags.integer("jobs", base::between(1, sweep::RunOptions::kMostJobs));
  if (flags.has("shard")) options.shard = sweep::parse_shard(flags.text("shard"));
  const bool is_quiet = flags.has("quiet");
  const ExperimentConfig config = requested(flags, options.folder);
  if (flags.has("request-only")) {
    if (!is_quiet) {
      std::printf("%zu cells requested in %s\n", config.sweep.num_cells(),
                  config_file(options.folder).c_str());
    }
    return kSuccess;
  }
  const sweep::RunProgress done =
      run_with_progress(experiments::dataset_experiment(), config,
                        begun_manifest("dataset run", arguments), options, is_quiet);
  if (!options.shard) {
    finish(options.folder, config, done, is_quiet);
  } else if (!is_quiet) {
    print_run(done);
    std::printf("written to %s\n", sweep::shard_folder(options.folder, *options.shard).c_str());
  }
  return kSuccess;
}

ExitCode run_dataset_merge(const std::vector<std::string>& arguments) {
  const Command command = merge_command_of_dataset();
  const Flags flags(command, arguments);
  if (is_help_printed(command, flags)) return kSuccess;
  const fs::path folder = flags.positional();
  const ExperimentConfig config = read_request(folder);
  const sweep::RunProgress done =
      sweep::merge_shards(experiments::dataset_experiment(), config,
                          begun_manifest("dataset merge", arguments), folder);
  finish(folder, config, done, flags.has("quiet"));
  return kSuccess;
}

ExitCode run_dataset_status(const std::vector<std::string>& arguments) {
  const Command command = status_command_of_dataset();
  const Flags flags(command, arguments);
  if (is_help_printed(command, flags)) return kSuccess;
  print_status(sweep::sweep_status(experiments::kDatasetSlug, flags.positional()));
  return kSuccess;
}

ExitCode run_dataset_pack(const std::vector<std::string>& arguments) {
  const Command command = pack_command_of_dataset();
  const Flags flags(command, arguments);
  if (is_help_printed(command, flags)) return kSuccess;
  const fs::path folder = fs::path(flags.positional() + "/").lexically_normal().parent_path();
  const fs::path archive = flags.has("archive") ? fs::path(flags.text("archive"))
                                                : fs::path(folder.string() + ".tar.gz");
  const DatasetArchive packed = pack_dataset(folder, archive);
  std::printf("%s: %lld bytes, SHA-256 %s\ncard %s\n", packed.file.c_str(),
              static_cast<long long>(packed.size), packed.sha256.c_str(), packed.card.c_str());
  return kSuccess;
}

constexpr std::array<NamedCommand, 4> kDatasetCommands = {{{"run", run_dataset_run},
                                                           {"status", run_dataset_status},
                                                           {"merge", run_dataset_merge},
                                                           {"pack", run_dataset_pack}}};

}  // namespace

bool is_dataset_command(const std::string& name) {
  return find_command(kDatasetCommands, name) != nullptr;
}

ExitCode run_dataset(const std::vector<std::string>& arguments) {
  return run_command(kDatasetCommands, "dataset", kDatasetUsage, arguments);
}

}  // namespace graspfit::app
