#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "graspfit/experiments/experiment_config.hpp"
#include "graspfit/experiments/run_manifest.hpp"

namespace graspfit::experiments {

/// How a run is going.
struct RunProgress {
  std::size_t num_cells = 0;
  std::size_t num_done = 0;     ///< Finished, in this run or an earlier one.
  std::size_t num_resumed = 0;  ///< Of these in an earlier one.
  std::size_t num_failed = 0;   ///< Of these with a reason instead of results.
  std::size_t num_skipped = 0;  ///< Data that is not there; not among `num_done`.
};

/// How to run.
struct RunOptions {
  std::filesystem::path folder;  ///< Of the results; made if need be.
  int jobs = 1;                  ///< Cells at once, ≥ 1. Timings are honest with one.
  void validate() const;         ///< Throws InvalidInput naming the field and its value.
};

/// Runs what is not done yet of an experiment, then writes its files:
///
///     <slug>.csv             one row per cell in sweep order: axes, cell_seed, status, reason,
///                            columns; the same bytes for any `jobs` and any interruption
///     <slug>.timing.csv      axes, wall_s and cpu_s of the cell, timings
///     <slug>.details.csv     axes and `Experiment::details`, where it has any: rows of finished
///                            cells in sweep order
///     <slug>.summary.csv     `Experiment::summary`, where it has any
///     <slug>.manifest.json   see RunManifest
///     <slug>.cells           finished cells, a checked line each, appended and flushed to disk
///                            one by one: a kill at any moment loses at most the running cells
///
/// `status` is ok, failed (`reason` says why; results are empty) or skipped (data not there).
/// `manifest` is what of it is known beforehand. `progress` is called after every cell, by one
/// thread at a time.
///
/// @throws InvalidInput if the folder holds results of another configuration or another build;
/// IoError if it is in use by another run or cannot be written.
RunProgress run_sweep(const Experiment& experiment, const ExperimentConfig& config,
                      RunManifest manifest, const RunOptions& options,
                      const std::function<void(const RunProgress&)>& progress = {});

/// The folder in which a cell keeps files beside its row, such as grasps.json.
std::filesystem::path cell_folder(const std::filesystem::path& results, const Cell& cell);

}  // namespace graspfit::experiments
