#include "commands/sweep_runs.hpp"

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <sstream>

#include "commands/commands.hpp"
#include "output/progress_bar.hpp"
#include "output/text_table.hpp"

namespace graspfit::app {
namespace {

std::string minutes_text(std::size_t cells, double cells_per_s) {
  constexpr double kSecondsPerMinute = 60.0;
  return fixed_decimal(static_cast<double>(cells) / cells_per_s / kSecondsPerMinute, 1) +
         " min left";
}

/// Progress as text: "12 of 110 cells, 0.31 per s, 5 min left"; the rate is of this run alone.
std::string progress_text(const sweep::RunProgress& progress,
                          std::chrono::steady_clock::time_point start) {
  const std::size_t reached = progress.num_done + progress.num_skipped;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  const double rate = static_cast<double>(reached - progress.num_resumed) / elapsed.count();
  return std::to_string(reached) + " of " + std::to_string(progress.num_cells) + " cells, " +
         fixed_decimal(rate, 2) + " per s, " + minutes_text(progress.num_cells - reached, rate);
}

std::string status_text(const sweep::SweepStatus& status) {
  std::string text = std::to_string(status.num_done) + " of " + std::to_string(status.num_cells) +
                     " cells done, " + std::to_string(status.num_failed) + " of these failed, " +
                     std::to_string(status.num_left()) + " left";
  if (status.num_tried_again > 0) {
    text += " (" + std::to_string(status.num_tried_again) + " tried in vain)";
  }
  if (status.is_running) text += ", running";
  if (!status.cells_per_s) return text;
  text += ", " + fixed_decimal(*status.cells_per_s, 2) + " per s";
  if (status.is_running) text += ", " + minutes_text(status.num_left(), *status.cells_per_s);
  return text;
}

/// The number of failed cells as text: "2 of these failed", and how many of them the next run tries
/// again.
std::string failures_text(const sweep::RunProgress& done) {
  std::string text = std::to_string(done.num_failed) + " of these failed";
  if (done.num_not_final > 0) {
    text += " (" + std::to_string(done.num_not_final) + " to be tried again by the next run)";
  }
  return text;
}

}  // namespace

sweep::RunManifest begun_manifest(const std::string& command,
                                  const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {"graspfit"};
  std::istringstream stream(command);
  for (std::string word; stream >> word;) words.push_back(word);
  words.insert(words.end(), arguments.begin(), arguments.end());
  sweep::RunManifest manifest;
  manifest.command = sweep::recorded_command(words);
  manifest.versions = version_rows();
  return manifest;
}

sweep::RunProgress run_with_progress(const sweep::Experiment& experiment,
                                     const sweep::ExperimentConfig& config,
                                     const sweep::RunManifest& manifest,
                                     const sweep::RunOptions& options, bool is_quiet) {
  ProgressBar bar(!is_quiet);
  const auto start = std::chrono::steady_clock::now();
  return sweep::run_sweep(
      experiment, config, manifest, options, [&](const sweep::RunProgress& progress) {
        const std::size_t reached = progress.num_done + progress.num_skipped;
        bar.show(static_cast<std::int64_t>(reached), static_cast<std::int64_t>(progress.num_cells),
                 progress_text(progress, start));
      });
}

void print_run(const sweep::RunProgress& done) {
  std::printf("%zu cells: %zu finished (%zu earlier), %s, %zu skipped\n", done.num_cells,
              done.num_done, done.num_resumed, failures_text(done).c_str(), done.num_skipped);
  if (!done.first_reason.empty()) {
    std::printf("first without result: %s\n", done.first_reason.c_str());
  }
}

void print_status(const std::vector<sweep::SweepStatus>& statuses) {
  for (const sweep::SweepStatus& status : statuses) {
    std::printf("%-16s %s\n", status.name.c_str(), status_text(status).c_str());
  }
}

}  // namespace graspfit::app
