#include "graspfit/experiments/sweep_runner.hpp"

#include <atomic>
#include <chrono>
#include <exception>
#include <map>
#include <mutex>
#include <new>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <thread>

#include "graspfit/geometry/atomic_file.hpp"
#include "internal/cell_journal.hpp"
#include "internal/data_files.hpp"
#include "internal/thread_clock.hpp"

namespace graspfit::experiments {
namespace {

namespace fs = std::filesystem;
using internal::CellJournal;
using internal::CellRecord;

/// What became of a cell, and whether that may be kept: a cell that lacks data or memory may do
/// better next time.
struct CellOutcome {
  CellRecord record;
  bool is_final = true;
};

CellOutcome without_results(const Experiment& experiment, const char* status, const char* reason,
                            bool is_final) {
  return {{status,
           csv_field(std::string(reason)),
           ResultRow(experiment.columns).csv_fields(),
           ResultRow(experiment.timings).csv_fields(),
           {}},
          is_final};
}

CellOutcome run_cell(const Experiment& experiment, const Cell& cell, const fs::path& folder) {
  try {
    const CellResult result = experiment.run(cell, cell_folder(folder, cell));
    CellOutcome outcome{{"ok", "", result.row.csv_fields(), result.timings.csv_fields(), {}}, true};
    for (const ResultRow& row : result.details) outcome.record.details.push_back(row.csv_fields());
    return outcome;
  } catch (const MissingData& error) {
    return without_results(experiment, "skipped", error.what(), false);
  } catch (const geometry::IoError& error) {  // a full disk may have room tomorrow
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
  Run(const Experiment& experiment, const ExperimentConfig& config, const RunManifest& manifest,
      const RunOptions& options, const std::function<void(const RunProgress&)>& progress)
      : experiment_(experiment),
        sweep_(config.sweep),
        options_(options),
        callback_(progress),
        journal_(options.folder / (experiment.slug + ".cells"),
                 {{"configuration", geometry::sha256_hex(config.identity())},
                  {"build of the program", manifest.program}},
                 config.sweep.num_cells()) {
    progress_.num_cells = sweep_.num_cells();
    for (std::size_t i = 0; i < progress_.num_cells; ++i) {
      if (!journal_.has(i)) continue;
      ++progress_.num_done;
      ++progress_.num_resumed;
      if (journal_.read(i).status == "failed") ++progress_.num_failed;
    }
  }

  RunProgress work() {
    std::vector<std::thread> threads;
    for (int i = 1; i < options_.jobs; ++i) threads.emplace_back([this] { work_until_done(); });
    work_until_done();
    for (std::thread& thread : threads) thread.join();
    if (error_) std::rethrow_exception(error_);
    return progress_;
  }

  CellRecord record(std::size_t cell) const {
    const auto open = open_cells_.find(cell);
    return open == open_cells_.end() ? journal_.read(cell) : open->second;
  }

 private:
  void work_until_done() {
    try {
      for (std::size_t i = next_++; i < sweep_.num_cells() && !is_stopped_; i = next_++) {
        if (!journal_.has(i)) run_one(i);
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
    const double cpu_start = internal::thread_cpu_s();
    CellOutcome outcome = run_cell(experiment_, cell, options_.folder);
    const double cpu_s = internal::thread_cpu_s() - cpu_start;
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    outcome.record.timings.insert(outcome.record.timings.begin(),
                                  {csv_field(wall.count()), csv_field(cpu_s)});
    if (outcome.is_final) journal_.append(index, cell.key, outcome.record);

    const std::lock_guard lock(mutex_);
    const bool is_skipped = outcome.record.status == "skipped";
    if (is_skipped) ++progress_.num_skipped;
    if (!is_skipped) ++progress_.num_done;
    if (outcome.record.status == "failed") ++progress_.num_failed;
    if (!outcome.is_final) open_cells_.emplace(index, std::move(outcome.record));
    if (callback_) callback_(progress_);
  }

  const Experiment& experiment_;
  const ParameterSweep& sweep_;
  const RunOptions& options_;
  const std::function<void(const RunProgress&)>& callback_;
  CellJournal journal_;
  RunProgress progress_;
  std::map<std::size_t, CellRecord> open_cells_;  ///< Not kept; by index.
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> is_stopped_{false};
  std::exception_ptr error_;
  std::mutex mutex_;
};

std::vector<std::string> header(const ParameterSweep& sweep, std::vector<std::string> own,
                                const std::vector<Column>& columns) {
  std::vector<std::string> names;
  for (const Axis& axis : sweep.axes) names.push_back(axis.name);
  names.insert(names.end(), own.begin(), own.end());
  for (const Column& column : columns) names.push_back(column.name);
  return names;
}

/// The tables beside the cells' rows: `details`, and `summary` made of them.
void write_further_tables(const Experiment& experiment, const ParameterSweep& sweep, const Run& run,
                          const fs::path& folder) {
  if (experiment.details.empty()) return;
  std::string details = csv_line(header(sweep, {}, experiment.details));
  std::vector<FinishedCell> cells;
  for (std::size_t i = 0; i < sweep.num_cells(); ++i) {
    CellRecord record = run.record(i);
    if (record.status != "ok") continue;
    cells.push_back({sweep.cell(i).labels, std::move(record.details)});
    for (const std::vector<std::string>& detail : cells.back().details) {
      std::vector<std::string> row = cells.back().labels;
      row.insert(row.end(), detail.begin(), detail.end());
      details += csv_line(row);
    }
  }
  geometry::write_file_atomically(folder / (experiment.slug + ".details.csv"), details);
  std::vector<SummaryTable> summaries = experiment.further_summaries;
  if (!experiment.summary.empty()) {
    summaries.push_back({"summary", experiment.summary, experiment.summarize});
  }
  for (const SummaryTable& summary : summaries) {
    std::string text = csv_line(header({}, {}, summary.columns));
    for (const ResultRow& row : summary.rows(sweep, cells)) text += csv_line(row.csv_fields());
    geometry::write_file_atomically(folder / (experiment.slug + '.' + summary.name + ".csv"), text);
  }
}

void write_tables(const Experiment& experiment, const ParameterSweep& sweep, const Run& run,
                  const fs::path& folder) {
  std::string results =
      csv_line(header(sweep, {"cell_seed", "status", "reason"}, experiment.columns));
  std::string timings = csv_line(header(sweep, {"wall_s", "cpu_s"}, experiment.timings));
  for (std::size_t i = 0; i < sweep.num_cells(); ++i) {
    const Cell cell = sweep.cell(i);
    const CellRecord record = run.record(i);
    std::vector<std::string> row = cell.labels;
    row.insert(row.end(), {std::to_string(cell.seed), record.status, record.reason});
    row.insert(row.end(), record.fields.begin(), record.fields.end());
    results += csv_line(row);
    row = cell.labels;
    row.insert(row.end(), record.timings.begin(), record.timings.end());
    timings += csv_line(row);
  }
  geometry::write_file_atomically(folder / (experiment.slug + ".csv"), results);
  geometry::write_file_atomically(folder / (experiment.slug + ".timing.csv"), timings);
}

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
    hashes[internal::name_of_input(file)] = geometry::sha256_hex(geometry::read_file(file));
  }
  return hashes;
}

}  // namespace

void RunOptions::validate() const {
  if (folder.empty()) throw geometry::InvalidInput("RunOptions: folder is empty");
  if (jobs < 1) {
    throw geometry::InvalidInput("RunOptions: jobs = " + std::to_string(jobs) + ", must be >= 1");
  }
}

fs::path cell_folder(const fs::path& results, const Cell& cell) {
  std::string name;
  // No label holds a comma, so no two cells share a folder.
  for (const std::string& label : cell.labels) name += (name.empty() ? "" : ",") + label;
  return results / "cells" / name;
}

RunProgress run_sweep(const Experiment& experiment, const ExperimentConfig& config,
                      RunManifest manifest, const RunOptions& options,
                      const std::function<void(const RunProgress&)>& progress) {
  options.validate();
  std::error_code error;
  fs::create_directories(options.folder, error);
  if (error) throw geometry::IoError(options.folder.string() + ": " + error.message());
  Run run(experiment, config, manifest, options, progress);
  const RunProgress done = run.work();
  write_tables(experiment, config.sweep, run, options.folder);
  write_further_tables(experiment, config.sweep, run, options.folder);
  manifest.inputs = input_hashes(experiment, config.sweep);
  const nlohmann::ordered_json counts = {{"total", done.num_cells},
                                         {"finished", done.num_done},
                                         {"failed", done.num_failed},
                                         {"skipped", done.num_skipped}};
  geometry::write_file_atomically(options.folder / (experiment.slug + ".manifest.json"),
                                  to_json(manifest, config, counts.dump()));
  return done;
}

}  // namespace graspfit::experiments
