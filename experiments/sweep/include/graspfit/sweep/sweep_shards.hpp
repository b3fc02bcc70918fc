#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/sweep/sweep_runner.hpp"

namespace graspfit::sweep {

/// Takes the cells of all shards in `folder` over into it and writes the files of `run_sweep`. They
/// are the same bytes as those of one run, whatever the shards are: they may be of several
/// partitions and overlap, and the folder may have cells of its own. It may be stopped and
/// repeated.
///
/// @throws InvalidInput if there are no shards, if they are of another configuration, another build
/// or other inputs, if two have different results of a cell, or if cells are missing (those there
/// are have been taken over then); IoError if a shard or the folder is in use; MissingData if all
/// cells were skipped.
RunProgress merge_shards(const Experiment& experiment, const ExperimentConfig& config,
                         RunManifest manifest, const std::filesystem::path& folder);

/// How far the results in a folder are, or those of a shard in it.
struct SweepStatus {
  std::string name;  ///< "all", "run" for a run without shards, "shard 2-of-7".
  std::size_t num_cells = 0;
  std::size_t num_done = 0;         ///< Finished for good.
  std::size_t num_failed = 0;       ///< Of these.
  std::size_t num_tried_again = 0;  ///< Not done: tried in vain, by the next run again (no data).
  bool is_running = false;
  std::optional<double> cells_per_s;  ///< Of its last run; none before its first cell.

  std::size_t num_left() const { return num_cells - num_done; }
};

/// The whole sweep first ("all": a cell is done if it is done anywhere; its rate is that of all
/// that are running), then the folder's own run and its shards by name. Runs are not disturbed.
/// @throws InvalidInput if there are no results of that experiment, or of different configurations.
std::vector<SweepStatus> sweep_status(const std::string& slug, const std::filesystem::path& folder);

}  // namespace graspfit::sweep
