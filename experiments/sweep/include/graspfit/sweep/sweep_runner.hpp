#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "graspfit/sweep/experiment_config.hpp"
#include "graspfit/sweep/run_manifest.hpp"

namespace graspfit::sweep {

/// How a run is going.
struct RunProgress {
  std::size_t num_cells = 0;    ///< Cells of the sweep, or of the shard that is run.
  std::size_t num_done = 0;     ///< Cells finished, in this run or an earlier one.
  std::size_t num_resumed = 0;  ///< Of the finished cells, those of an earlier run.
  std::size_t num_failed = 0;   ///< Of the finished cells, those with a reason instead of results.
  std::size_t num_skipped = 0;  ///< Cells skipped for want of data; not among `num_done`.
  /// Of `num_failed` those with a reason that may pass (files, memory): the next run tries again.
  std::size_t num_not_final = 0;
  /// Labels and reason of the first cell in sweep order that failed or was skipped in this run;
  /// empty if there is none.
  std::string first_reason;
};

/// One of `count` parts of a sweep: the cells number index − 1, index − 1 + count, ...
struct Shard {
  static constexpr std::size_t kMostShards = 100000;
  std::size_t index = 1;  ///< In [1, count].
  std::size_t count = 1;  ///< In [1, kMostShards].

  std::size_t num_cells(std::size_t of_sweep) const;
  std::string name() const;  ///< "2-of-7", as its folder is named.
  void validate() const;     ///< Throws InvalidInput naming the field and its value.
};

/// Parses "2/7". @throws InvalidInput.
Shard parse_shard(const std::string& text);

/// How to run.
struct RunOptions {
  static constexpr int kMostJobs = 1024;
  std::filesystem::path folder;  ///< Folder of the results; made if need be.
  int jobs = 1;  ///< Number of cells that run at once, in [1, kMostJobs]. Timings are honest with
                 ///< one.
  std::optional<Shard> shard = {};  ///< Only this part of the sweep, into a folder of its own.
  void validate() const;            ///< Throws InvalidInput naming the field and its value.
};

/// Runs what is not done yet of an experiment, then writes its files:
///
///     <slug>.csv             one row per cell in sweep order: axes, cell_seed, status, reason,
///                            columns; the same bytes for any `jobs`, any interruption and any
///                            shards
///     <slug>.timing.csv      axes, wall_s and cpu_s of the cell, timings
///     <slug>.details.csv     axes and `Experiment::details`, where it has any: rows of finished
///                            cells in sweep order
///     <slug>.<name>.csv      `Experiment::summaries`, where it has any
///     <slug>.manifest.json   see RunManifest
///     <slug>.cells           finished cells, a checked line each, appended and flushed to disk
///                            one by one: a kill at any moment loses at most the running cells
///
/// `status` is ok, failed (`reason` says why; results are empty) or skipped (data not there).
/// `manifest` is what of it is known beforehand; the inputs' hashes are taken before the first cell
/// and checked after the last. `progress` is called after every cell, by one thread at a time.
///
/// A shard writes manifest and finished cells only, into `shard_folder`; `merge_shards` does the
/// rest.
///
/// @throws InvalidInput if the folder holds results of another configuration, another build or
/// other inputs; IoError if it is in use by another run or cannot be written, if threads for `jobs`
/// cannot be started, or if an input changes during the run; MissingData, and no tables, if all
/// cells were skipped. A shard of skipped cells is no error: another one may have results.
RunProgress run_sweep(const Experiment& experiment, const ExperimentConfig& config,
                      RunManifest manifest, const RunOptions& options,
                      const std::function<void(const RunProgress&)>& progress = {});

/// The folder in which a cell keeps files beside its row, such as grasps.json.
std::filesystem::path cell_folder(const std::filesystem::path& results, const Cell& cell);

/// The folder of a shard in that of the results.
std::filesystem::path shard_folder(const std::filesystem::path& results, const Shard& shard);

}  // namespace graspfit::sweep
