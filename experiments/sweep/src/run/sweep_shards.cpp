#include "graspfit/sweep/sweep_shards.hpp"

#include <algorithm>
#include <optional>
#include <system_error>

#include "graspfit/base/json_bounds.hpp"
#include "run/sweep_tables.hpp"

namespace graspfit::sweep {
namespace {

namespace fs = std::filesystem;
using internal::CellJournal;
using internal::CellRecord;
using internal::JournalContent;

/// The shard that a folder is named after; none if it is named otherwise.
std::optional<Shard> shard_named(std::string name) {
  const std::size_t of = name.find("-of-");
  if (of == std::string::npos) return std::nullopt;
  try {
    const Shard shard = parse_shard(name.replace(of, 4, "/"));
    return shard;
  } catch (const base::InvalidInput&) {
    return std::nullopt;
  }
}

/// The shards in a folder of results that have begun, in the order of count and index.
std::vector<Shard> shards_in(const fs::path& results, const std::string& slug) {
  std::vector<Shard> shards;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(results / "shards", error)) {
    const std::optional<Shard> shard = shard_named(entry.path().filename().string());
    if (shard && fs::exists(internal::journal_file(entry.path(), slug))) shards.push_back(*shard);
  }
  std::sort(shards.begin(), shards.end(), [](const Shard& a, const Shard& b) {
    return std::pair(a.count, a.index) < std::pair(b.count, b.index);
  });
  return shards;
}

/// Copies the files that the shard's cells keep beside their rows, where the results lack the cell.
void copy_cell_folders(const ParameterSweep& sweep, const CellJournal& from, const fs::path& shard,
                       const CellJournal& to, const fs::path& results) {
  for (std::size_t i = 0; i < sweep.num_cells(); ++i) {
    if (!from.has(i) || to.has(i)) continue;
    const Cell cell = sweep.cell(i);
    const fs::path source = cell_folder(shard, cell);
    std::error_code error;
    if (!fs::is_directory(source, error)) continue;
    const fs::path target = cell_folder(results, cell);
    internal::make_folder(target);
    fs::copy(source, target, fs::copy_options::recursive | fs::copy_options::overwrite_existing,
             error);
    if (error) throw base::IoError(target.string() + ": " + error.message());
  }
}

/// @throws InvalidInput that says how many cells are missing and which is the first.
void require_all(const ParameterSweep& sweep, const CellJournal& journal, const fs::path& folder) {
  std::size_t num_missing = 0;
  std::string first;
  for (std::size_t i = sweep.num_cells(); i-- > 0;) {
    if (journal.is_known(i)) continue;
    ++num_missing;
    first = sweep.cell(i).key;
  }
  if (num_missing == 0) return;
  throw base::InvalidInput(folder.string() + ": " + std::to_string(num_missing) + " of " +
                           std::to_string(sweep.num_cells()) + " cells are missing, " + first +
                           " first; run their shards, or without --shard all that is left");
}

RunProgress counts_of(const ParameterSweep& sweep, const CellJournal& journal) {
  RunProgress counts;
  counts.num_cells = journal.num_cells();
  for (std::size_t i = 0; i < counts.num_cells; ++i) {
    const CellRecord record = journal.read(i);
    if (record.status == "skipped") ++counts.num_skipped;
    if (record.status != "skipped") ++counts.num_done;
    if (record.status == "failed") ++counts.num_failed;
    if (record.status == "failed" && !record.is_final) ++counts.num_not_final;
    if (record.status != "ok" && counts.first_reason.empty()) {
      counts.first_reason = sweep.cell(i).key + ": " + internal::text_of_field(record.reason);
    }
  }
  counts.num_resumed = counts.num_done;
  return counts;
}

SweepStatus status_of(const JournalContent& content, const std::string& name,
                      const std::optional<Shard>& shard, bool is_running) {
  SweepStatus status;
  status.name = name;
  status.num_cells = shard.value_or(Shard{}).num_cells(content.cells.size());
  status.is_running = is_running;
  for (const JournalContent::Line& line : content.cells) {
    if (line.is_final) ++status.num_done;
    if (line.is_final && line.is_failed) ++status.num_failed;
    if (line.offset && !line.is_final) ++status.num_tried_again;
  }
  const double seconds = content.last_cell_s - content.last_start_s;
  if (content.num_cells_since_start > 0 && seconds > 0.0) {
    status.cells_per_s = static_cast<double>(content.num_cells_since_start) / seconds;
  }
  return status;
}

/// Adds the cells of a journal to those of the whole sweep.
void add_to(JournalContent& whole, const JournalContent& content, const fs::path& folder) {
  if (!whole.has_header) {
    whole.identity = content.identity;
    whole.cells.resize(content.cells.size());
    whole.has_header = true;
  }
  if (whole.identity != content.identity || whole.cells.size() != content.cells.size()) {
    throw base::InvalidInput(folder.string() +
                             ": holds results of different configurations or builds");
  }
  for (std::size_t i = 0; i < whole.cells.size(); ++i) {
    const JournalContent::Line& line = content.cells[i];
    if (!line.offset || whole.cells[i].is_final) continue;
    whole.cells[i] = line;
  }
}

}  // namespace

RunProgress merge_shards(const Experiment& experiment, const ExperimentConfig& config,
                         RunManifest manifest, const fs::path& folder) {
  internal::require_own_folder(folder, experiment.slug);
  const std::vector<Shard> shards = shards_in(folder, experiment.slug);
  if (shards.empty()) {
    throw base::InvalidInput(folder.string() + ": has no shards of " + experiment.slug);
  }
  const internal::JournalIdentity identity = internal::journal_identity(config, manifest);
  const std::size_t num_cells = config.sweep.num_cells();
  // What does not belong together is refused before the folder's own journal is begun.
  for (const Shard& shard : shards) {
    const fs::path source = shard_folder(folder, shard);
    const CellJournal part(internal::journal_file(source, experiment.slug), identity, num_cells);
  }
  CellJournal journal(internal::journal_file(folder, experiment.slug), identity, num_cells);
  for (const Shard& shard : shards) {
    const fs::path source = shard_folder(folder, shard);
    const CellJournal part(internal::journal_file(source, experiment.slug), identity, num_cells);
    copy_cell_folders(config.sweep, part, source, journal, folder);
    journal.absorb(part);
    const fs::path shard_manifest = source / (experiment.slug + ".manifest.json");
    if (fs::exists(shard_manifest)) {
      manifest.shards.push_back(base::read_json_file(shard_manifest));
    }
  }
  require_all(config.sweep, journal, folder);
  const RunProgress counts = counts_of(config.sweep, journal);
  internal::require_some_result(counts);
  manifest.inputs = journal.inputs();
  internal::write_tables(experiment, config, manifest, counts, journal, folder);
  return counts;
}

std::vector<SweepStatus> sweep_status(const std::string& slug, const fs::path& folder) {
  JournalContent whole;
  std::vector<SweepStatus> all(1);
  const auto add = [&](const fs::path& where, const std::string& name,
                       const std::optional<Shard>& shard) {
    const fs::path file = internal::journal_file(where, slug);
    if (!fs::exists(file)) return;
    const JournalContent content = internal::read_journal(file);
    if (!content.has_header) return;  // begun this very moment
    add_to(whole, content, folder);
    all.push_back(status_of(content, name, shard, internal::is_journal_in_use(file)));
  };
  add(folder, "run", std::nullopt);
  for (const Shard& shard : shards_in(folder, slug)) {
    add(shard_folder(folder, shard), "shard " + shard.name(), shard);
  }
  if (!whole.has_header) {
    throw base::InvalidInput(folder.string() + ": has no results of " + slug);
  }
  all[0] = status_of(whole, "all", std::nullopt, false);
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (!all[i].is_running) continue;
    all[0].is_running = true;
    if (all[i].cells_per_s) {
      all[0].cells_per_s = all[0].cells_per_s.value_or(0.0) + *all[i].cells_per_s;
    }
  }
  return all;
}

}  // namespace graspfit::sweep
