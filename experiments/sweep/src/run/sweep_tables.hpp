#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "graspfit/sweep/experiment_config.hpp"
#include "graspfit/sweep/run_manifest.hpp"
#include "graspfit/sweep/sweep_runner.hpp"
#include "run/cell_journal.hpp"

namespace graspfit::sweep::internal {

/// Returns the path of the journal of an experiment's results in a folder.
std::filesystem::path journal_file(const std::filesystem::path& folder, const std::string& slug);

/// What the cells of a journal must have in common.
JournalIdentity journal_identity(const ExperimentConfig& config, const RunManifest& manifest);

/// Refuses a folder that holds results, or shards of them, of another experiment: cells of both
/// keep files under the same names. @throws InvalidInput that names that experiment.
void require_own_folder(const std::filesystem::path& folder, const std::string& slug);

/// Makes a folder. @throws IoError.
void make_folder(const std::filesystem::path& folder);

/// Returns the text that a CSV field of a journal stands for.
std::string text_of_field(const std::string& field);

/// Refuses to make tables without results. @throws MissingData, with the first reason, if all cells
/// were skipped.
void require_some_result(const RunProgress& counts);

/// The files of `run_sweep` from a journal that knows all cells: tables, then the manifest. Memory
/// holds one row, but for details that a summary is made of. `manifest` gets the tables' hashes.
void write_tables(const Experiment& experiment, const ExperimentConfig& config,
                  RunManifest manifest, const RunProgress& counts, const CellJournal& journal,
                  const std::filesystem::path& folder);

/// File names of all tables of an experiment.
std::vector<std::string> table_names(const Experiment& experiment);

/// Writes only the manifest.
void write_manifest(const ExperimentConfig& config, const RunManifest& manifest,
                    const RunProgress& counts, const std::filesystem::path& folder);

}  // namespace graspfit::sweep::internal
