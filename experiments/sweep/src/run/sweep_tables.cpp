#include "run/sweep_tables.hpp"

#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <system_error>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/atomic_file_writer.hpp"
#include "graspfit/base/sha256.hpp"

namespace graspfit::sweep::internal {
namespace {

namespace fs = std::filesystem;
using base::AtomicFileWriter;

std::vector<std::string> header(const ParameterSweep& sweep, const std::vector<std::string>& own,
                                const std::vector<Column>& columns) {
  std::vector<std::string> names;
  for (const Axis& axis : sweep.axes) names.push_back(axis.name);
  names.insert(names.end(), own.begin(), own.end());
  for (const Column& column : columns) names.push_back(column.name);
  return names;
}

std::string joined(std::vector<std::string> labels, const std::vector<std::string>& fields) {
  labels.insert(labels.end(), fields.begin(), fields.end());
  return csv_line(labels);
}

/// The tables with rows of cells: results, timings, and details where the experiment has any.
void write_cell_tables(const Experiment& experiment, const ParameterSweep& sweep,
                       const CellJournal& journal, const fs::path& folder) {
  AtomicFileWriter results(folder / (experiment.slug + ".csv"));
  AtomicFileWriter timings(folder / (experiment.slug + ".timing.csv"));
  std::optional<AtomicFileWriter> details;
  results.write(csv_line(header(sweep, {"cell_seed", "status", "reason"}, experiment.columns)));
  timings.write(csv_line(header(sweep, {"wall_s", "cpu_s"}, experiment.timings)));
  if (!experiment.details.empty()) {
    details.emplace(folder / (experiment.slug + ".details.csv"));
    details->write(csv_line(header(sweep, {}, experiment.details)));
  }
  for (std::size_t i = 0; i < sweep.num_cells(); ++i) {
    const Cell cell = sweep.cell(i);
    const CellRecord record = journal.read(i);
    std::vector<std::string> row = cell.labels;
    row.insert(row.end(), {std::to_string(cell.seed), record.status, record.reason});
    results.write(joined(row, record.fields));
    timings.write(joined(cell.labels, record.timings));
    if (!details || record.status != "ok") continue;
    for (const std::vector<std::string>& detail : record.details) {
      details->write(joined(cell.labels, detail));
    }
  }
  results.commit();
  timings.commit();
  if (details) details->commit();
}

/// SHA-256 of all tables, by file name.
std::map<std::string, std::string> table_hashes(const Experiment& experiment,
                                                const fs::path& folder) {
  std::map<std::string, std::string> hashes;
  for (const std::string& name : table_names(experiment)) {
    hashes[name] = base::sha256_of_file(folder / name);
  }
  return hashes;
}

void write_summaries(const Experiment& experiment, const ParameterSweep& sweep,
                     const CellJournal& journal, const fs::path& folder) {
  if (experiment.summaries.empty()) return;
  std::vector<FinishedCell> cells;
  for (std::size_t i = 0; i < sweep.num_cells(); ++i) {
    CellRecord record = journal.read(i);
    if (record.status != "ok") continue;
    cells.push_back({sweep.cell(i).labels, std::move(record.details), std::move(record.fields)});
  }
  for (const SummaryTable& summary : experiment.summaries) {
    std::string text = csv_line(header({}, {}, summary.columns));
    for (const ResultRow& row : summary.rows(sweep, cells)) text += csv_line(row.csv_fields());
    base::write_file_atomically(folder / (experiment.slug + '.' + summary.name + ".csv"), text);
  }
}

}  // namespace

fs::path journal_file(const fs::path& folder, const std::string& slug) {
  return folder / (slug + ".cells");
}

std::vector<std::string> table_names(const Experiment& experiment) {
  std::vector<std::string> names = {experiment.slug + ".csv", experiment.slug + ".timing.csv"};
  if (!experiment.details.empty()) names.push_back(experiment.slug + ".details.csv");
  for (const SummaryTable& summary : experiment.summaries) {
    names.push_back(experiment.slug + '.' + summary.name + ".csv");
  }
  return names;
}

JournalIdentity journal_identity(const ExperimentConfig& config, const RunManifest& manifest) {
  return {{"configuration", base::sha256_hex(config.identity())},
          {"build of the program", manifest.program}};
}

void require_own_folder(const fs::path& folder, const std::string& slug) {
  std::vector<fs::path> searched = {folder};
  std::error_code error;
  for (const fs::directory_entry& shard : fs::directory_iterator(folder / "shards", error)) {
    searched.push_back(shard.path());
  }
  std::set<std::string> others;  // sorted by name, as folders have no order
  for (const fs::path& directory : searched) {
    for (const fs::directory_entry& entry : fs::directory_iterator(directory, error)) {
      const std::string name = entry.path().filename().string();
      for (const std::string_view ending : {".cells", ".manifest.json"}) {
        if (!name.ends_with(ending)) continue;
        const std::string owner = name.substr(0, name.size() - ending.size());
        if (!owner.empty() && owner != slug) others.insert(owner);
      }
    }
  }
  if (others.empty()) return;
  throw base::InvalidInput(folder.string() + ": holds results of " + *others.begin() + "; give " +
                           slug + " another folder (--out)");
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw base::IoError(folder.string() + ": " + error.message());
}

std::string text_of_field(const std::string& field) {
  if (!field.starts_with('"')) return field;
  std::string text;
  for (std::size_t i = 1; i + 1 < field.size(); ++i) {
    text += field[i];
    if (field[i] == '"') ++i;  // quotes are doubled
  }
  return text;
}

void require_some_result(const RunProgress& counts) {
  if (counts.num_skipped == 0 || counts.num_skipped < counts.num_cells) return;
  throw MissingData("all " + std::to_string(counts.num_cells) +
                    " cells were skipped, so there is no table; the first, " + counts.first_reason);
}

void write_manifest(const ExperimentConfig& config, const RunManifest& manifest,
                    const RunProgress& counts, const fs::path& folder) {
  const nlohmann::ordered_json json = {{"total", counts.num_cells},
                                       {"finished", counts.num_done},
                                       {"failed", counts.num_failed},
                                       {"skipped", counts.num_skipped},
                                       {"not_final", counts.num_not_final}};
  base::write_file_atomically(folder / (config.sweep.experiment + ".manifest.json"),
                              to_json(manifest, config, json.dump()));
}

void write_tables(const Experiment& experiment, const ExperimentConfig& config,
                  RunManifest manifest, const RunProgress& counts, const CellJournal& journal,
                  const fs::path& folder) {
  write_cell_tables(experiment, config.sweep, journal, folder);
  write_summaries(experiment, config.sweep, journal, folder);
  manifest.tables = table_hashes(experiment, folder);
  write_manifest(config, manifest, counts, folder);
}

}  // namespace graspfit::sweep::internal
