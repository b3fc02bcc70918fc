#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/sweep/sweep_runner.hpp"

namespace graspfit::sweep {

/// Takes the cells of all shards in `folder` over into the results of that folder and writes the
/// files of `run_sweep`. They are the same bytes as those of one run, whatever the shards are:
/// shards may be of several partitions and overlap, and the folder may have cells of its own. The
/// merge may be interrupted and repeated.
///
/// @throws InvalidInput if there are no shards, if they are of another configuration, another build
/// or other inputs, if two have different results of a cell, or if cells are missing (the existing
/// cells have been taken over then); IoError if a shard or the folder is in use; MissingData if all
/// cells were skipped.
RunProgress merge_shards(const Experiment& experiment, const ExperimentConfig& config,
                         RunManifest manifest, const std::filesystem::path& folder);

/// How far the results in a folder are, or those of a shard in it.
struct SweepStatus {
  std::string name;  ///< "all", "run" for a run without shards, "shard 2-of-7".
  std::size_t num_cells = 0;
  std::size_t num_done = 0;         ///< Finished for good.
  std::size_t num_failed = 0;       ///< Of the finished cells, those that failed.
  std::size_t num_tried_again = 0;  ///< Cells tried in vain (no data, files or memory), which are
                                    ///< not done: the next run tries them again.
  bool is_running = false;
  std::optional<double> cells_per_s;  ///< Rate of the last run; none before its first cell.

  std::size_t num_left() const { return num_cells - num_done; }
};

/// Returns the status of the whole sweep first ("all": a cell is done if any run has finished it;
/// the rate is the sum over the runs in progress), then of the folder's own run and of its shards,
/// ordered by their count and index. Runs are not disturbed.
/// @throws InvalidInput if there are no results of that experiment, or of different configurations.
std::vector<SweepStatus> sweep_status(const std::string& slug, const std::filesystem::path& folder);

}  // namespace graspfit::sweep
