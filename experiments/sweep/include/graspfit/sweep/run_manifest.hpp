#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "graspfit/sweep/experiment_config.hpp"

namespace graspfit::sweep {

/// The sources that this library was built from.
struct BuildSource {
  std::string commit;     ///< Empty where the sources were not under version control.
  bool is_clean = false;  ///< Nothing differed from that commit, published results aside.
};
BuildSource build_source();

/// SHA-256 of the running program, empty where the system does not say which it is.
std::string program_sha256();

/// A command line as a manifest records it: words of a shell, quoted where need be, without
/// `--out` and its folder, which are of one machine and change no result.
std::string recorded_command(const std::vector<std::string>& words);

/// Everything needed to run an experiment again. Written beside its results, never compared.
struct RunManifest {
  std::string command;                                        ///< See `recorded_command`.
  std::vector<std::pair<std::string, std::string>> versions;  ///< Of program, compiler, libraries.
  BuildSource source = build_source();
  std::string program = program_sha256();
  /// SHA-256 by file: relative to the data folder or to the sources for files in them.
  std::map<std::string, std::string> inputs;
  std::map<std::string, std::string> tables = {};  ///< SHA-256 of the tables by file name.
  std::vector<std::string> shards = {};  ///< Texts of the manifests of shards that were merged.
};

/// The manifest's text: JSON with command, configuration, its hash, seed, commit, versions,
/// machine, inputs, tables, numbers of cells.
std::string to_json(const RunManifest& manifest, const ExperimentConfig& config,
                    const std::string& status_counts_json);

/// Copies the results of a finished run from `folder` into `published` (`notebooks-data`), and
/// writes the dictionary of their columns beside them.
///
/// @throws InvalidInput, saying which, for a quick or modified configuration, cells that were
/// skipped or failed for a reason that may pass, inputs outside the data folder and the sources
/// (their names mean nothing elsewhere), tables that are not the manifest's, a program that was not
/// built from a clean tree, and a tree at `sources` that is not, `published` and the figures' data
/// aside, the one that the program was built from.
void publish(const Experiment& experiment, const ExperimentConfig& config,
             const std::filesystem::path& folder, const std::filesystem::path& sources,
             const std::filesystem::path& published);

/// Checks that the tables beside a manifest are those that it was written for. Manifests written
/// before they named tables pass.
/// @throws IoError if a table cannot be read, InvalidInput that names a table that differs.
void require_tables_of_manifest(const std::filesystem::path& manifest);

/// Only the check of `publish` that looks at the manifest of a finished run.
void require_publishable_manifest(const std::filesystem::path& manifest);

/// Only the check of `publish` that can be made before the work.
void require_publishable(const ExperimentConfig& config, const std::filesystem::path& sources);

}  // namespace graspfit::sweep
