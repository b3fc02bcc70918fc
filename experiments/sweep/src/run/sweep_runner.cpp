#include "graspfit/sweep/sweep_runner.hpp"

#include <atomic>
#include <charconv>
#include <chrono>
#include <exception>
#include <limits>
#include <mutex>
#include <new>
#include <set>
#include <thread>

#include "graspfit/base/sha256.hpp"
#include "graspfit/base/stopwatch.hpp"
#include "graspfit/sweep/data_files.hpp"
#include "run/cell_journal.hpp"
#include "run/sweep_tables.hpp"

namespace graspfit::sweep {
namespace {

namespace fs = std::filesystem;
using internal::CellJournal;
using internal::CellRecord;

/// A record without results. It is not final where the cell lacks data or memory: the next run may
/// do better.
CellRecord without_results(const Experiment& experiment, const char* status, const char* reason,
                           bool is_final) {
  return {status,
          csv_field(std::string(reason)),
          ResultRow(experiment.columns).csv_fields(),
          ResultRow(experiment.timings).csv_fields(),
          {},
          is_final};
}

CellRecord run_cell(const Experiment& experiment, const Cell& cell, const fs::path& folder) {
  try {
    const CellResult result = experiment.run(cell, cell_folder(folder, cell));
    CellRecord record{"ok", "", result.row.csv_fields(), result.timings.csv_fields(), {}, true};
    for (const ResultRow& row : result.details) record.details.push_back(row.csv_fields());
    return record;
  } catch (const MissingData& error) {
    return without_results(experiment, "skipped", error.what(), false);
  } catch (const base::IoError& error) {  // a full disk may have room tomorrow
    return without_results(experiment, "failed", error.what(), false);
  } catch (const std::bad_alloc&) {
    return without_results(experiment, "failed", "out of memory", false);
  } catch (const std::exception& error) {
    return without_results(experiment, "failed", error.what(), true);
  }
}

/// A run in progress.
class Run {
 public:
  Run(const Experiment& experiment, const ParameterSweep& sweep, const RunOptions& options,
      const fs::path& folder, CellJournal& journal,
      const std::function<void(const RunProgress&)>& progress)
      : experiment_(experiment),
        sweep_(sweep),
        jobs_(options.jobs),
        shard_(options.shard.value_or(Shard{})),
        folder_(folder),
        callback_(progress),
        journal_(journal) {
    progress_.num_cells = shard_.num_cells(sweep_.num_cells());
    for (std::size_t i = 0; i < progress_.num_cells; ++i) {
      if (!journal_.has(index_of(i))) continue;
      ++progress_.num_done;
      ++progress_.num_resumed;
      if (journal_.is_failed(index_of(i))) ++progress_.num_failed;
    }
  }

  RunProgress work() {
    std::vector<std::thread> threads;
    try {
      for (int i = 1; i < jobs_; ++i) threads.emplace_back([this] { work_until_done(); });
    } catch (const std::exception& error) {  // of the system, or for want of memory
      const std::lock_guard lock(mutex_);
      is_stopped_ = true;
      error_ = std::make_exception_ptr(base::IoError(
          "a run of " + std::to_string(jobs_) + " jobs: thread " +
          std::to_string(threads.size() + 1) + " cannot be started: " + error.what()));
    }
    work_until_done();
    for (std::thread& thread : threads) thread.join();
    if (error_) std::rethrow_exception(error_);
    return progress_;
  }

 private:
  /// Index in the sweep of a cell of the shard.
  std::size_t index_of(std::size_t cell) const { return shard_.index - 1 + cell * shard_.count; }

  void work_until_done() {
    try {
      for (std::size_t i = next_++; i < progress_.num_cells && !is_stopped_; i = next_++) {
        if (!journal_.has(index_of(i))) run_one(index_of(i));
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      is_stopped_ = true;
    }
  }

  void run_one(std::size_t index) {
    const Cell cell = sweep_.cell(index);
    const auto start = std::chrono::steady_clock::now();
    const double cpu_start = base::thread_cpu_s();
    CellRecord record = run_cell(experiment_, cell, folder_);
    const double cpu_s = base::thread_cpu_s() - cpu_start;
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    record.timings.insert(record.timings.begin(), {csv_field(wall.count()), csv_field(cpu_s)});
    journal_.append(index, cell.key, record);

    const std::lock_guard lock(mutex_);
    const bool is_skipped = record.status == "skipped";
    if (is_skipped) ++progress_.num_skipped;
    if (!is_skipped) ++progress_.num_done;
    if (record.status == "failed") ++progress_.num_failed;
    if (record.status == "failed" && !record.is_final) ++progress_.num_not_final;
    if ((is_skipped || record.status == "failed") && index < first_without_result_) {
      first_without_result_ = index;
      progress_.first_reason = cell.key + ": " + internal::text_of_field(record.reason);
    }
    if (callback_) callback_(progress_);
  }

  const Experiment& experiment_;
  const ParameterSweep& sweep_;
  const int jobs_;
  const Shard shard_;
  const fs::path& folder_;
  const std::function<void(const RunProgress&)>& callback_;
  CellJournal& journal_;
  RunProgress progress_;
  std::size_t first_without_result_ = std::numeric_limits<std::size_t>::max();
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> is_stopped_{false};
  std::exception_ptr error_;
  std::mutex mutex_;
};

std::map<std::string, std::string> input_hashes(const Experiment& experiment,
                                                const ParameterSweep& sweep) {
  std::set<fs::path> files;
  for (std::size_t i = 0; experiment.inputs && i < sweep.num_cells(); ++i) {
    for (const fs::path& file : experiment.inputs(sweep.cell(i))) files.insert(file);
  }
  std::map<std::string, std::string> hashes;
  std::error_code error;
  for (const fs::path& file : files) {
    if (!fs::is_regular_file(file, error)) continue;
    hashes[name_of_input(file)] = base::sha256_of_file(file);
  }
  return hashes;
}

/// @throws IoError that names an input that is not what it was when its hash was taken.
void require_unchanged(const std::map<std::string, std::string>& before,
                       const std::map<std::string, std::string>& after) {
  for (const auto& [file, hash] : before) {
    const auto now = after.find(file);
    if (now != after.end() && now->second == hash) continue;
    throw base::IoError(file + ": was " + (now == after.end() ? "removed" : "changed") +
                        " while the run was going; its tables are not written");
  }
}

}  // namespace

void RunOptions::validate() const {
  if (folder.empty()) throw base::InvalidInput("RunOptions: folder is empty");
  if (jobs < 1 || jobs > kMostJobs) {
    throw base::InvalidInput("RunOptions: jobs = " + std::to_string(jobs) + ", must be in [1, " +
                             std::to_string(kMostJobs) + "]");
  }
  if (shard) shard->validate();
}

std::size_t Shard::num_cells(std::size_t of_sweep) const {
  return (of_sweep + count - index) / count;
}

std::string Shard::name() const { return std::to_string(index) + "-of-" + std::to_string(count); }

void Shard::validate() const {
  if (count < 1 || count > kMostShards) {
    throw base::InvalidInput("Shard: count = " + std::to_string(count) + ", must be in [1, " +
                             std::to_string(kMostShards) + "]");
  }
  if (index < 1 || index > count) {
    throw base::InvalidInput("Shard: index = " + std::to_string(index) + ", must be in [1, " +
                             std::to_string(count) + "]");
  }
}

Shard parse_shard(const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto index = std::from_chars(text.data(), end, shard.index);
  const bool has_slash = index.ec == std::errc() && index.ptr != end && *index.ptr == '/';
  const auto count = std::from_chars(has_slash ? index.ptr + 1 : end, end, shard.count);
  if (!has_slash || count.ec != std::errc() || count.ptr != end) {
    throw base::InvalidInput("--shard \"" + text + "\" is not I/N, such as 2/7");
  }
  try {
    shard.validate();
  } catch (const base::InvalidInput&) {
    throw base::InvalidInput("--shard \"" + text + "\": I and N must be in 1 <= I <= N <= " +
                             std::to_string(Shard::kMostShards));
  }
  return shard;
}

fs::path cell_folder(const fs::path& results, const Cell& cell) {
  std::string name;
  // No label holds a comma, so no two cells share a folder.
  for (const std::string& label : cell.labels) name += (name.empty() ? "" : ",") + label;
  return results / "cells" / name;
}

fs::path shard_folder(const fs::path& results, const Shard& shard) {
  return results / "shards" / shard.name();
}

RunProgress run_sweep(const Experiment& experiment, const ExperimentConfig& config,
                      RunManifest manifest, const RunOptions& options,
                      const std::function<void(const RunProgress&)>& progress) {
  options.validate();
  internal::require_own_folder(options.folder, experiment.slug);
  const fs::path folder =
      options.shard ? shard_folder(options.folder, *options.shard) : options.folder;
  internal::make_folder(folder);
  CellJournal journal(internal::journal_file(folder, experiment.slug),
                      internal::journal_identity(config, manifest), config.sweep.num_cells());
  const std::map<std::string, std::string> before = input_hashes(experiment, config.sweep);
  journal.start_run(before);
  const RunProgress done = Run(experiment, config.sweep, options, folder, journal, progress).work();
  const std::map<std::string, std::string> after = input_hashes(experiment, config.sweep);
  require_unchanged(before, after);
  if (after.size() > before.size()) journal.start_run(after);  // files that appeared during the run
  manifest.inputs = journal.inputs();
  if (options.shard) {
    internal::write_manifest(config, manifest, done, folder);
  } else {
    internal::require_some_result(done);
    internal::write_tables(experiment, config, manifest, done, journal, folder);
  }
  return done;
}

}  // namespace graspfit::sweep
