#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace graspfit::sweep::internal {

/// What is kept of a cell: fields ready for CSV.
struct CellRecord {
  std::string status;  ///< "ok", "failed" or "skipped".
  std::string reason;  ///< As a CSV field.
  std::vector<std::string> fields;
  std::vector<std::string> timings;
  std::vector<std::vector<std::string>> details;
  bool is_final = true;  ///< Whether the record is final; otherwise the next run tries again.
};

/// What all cells of a journal have in common: names for messages, and values.
using JournalIdentity = std::map<std::string, std::string>;

/// A journal as it is on disk: a few bytes per cell.
struct JournalContent {
  /// The last line of a cell; only a final line replaces a final one.
  struct Line {
    std::optional<std::int64_t> offset;  ///< Of its beginning in the file; empty: none.
    bool is_final = false;
    bool is_failed = false;
  };
  JournalIdentity identity;
  std::vector<Line> cells;                    ///< One per cell of the sweep.
  std::map<std::string, std::string> inputs;  ///< SHA-256 of what its runs read, by name.
  std::int64_t size = 0;                      ///< Size up to the end of the last whole line.
  bool has_header = false;
  double last_start_s = 0.0;  ///< Start of the last run, in Unix time [s].
  double last_cell_s = 0.0;   ///< End of the last cell of that run, in Unix time [s].
  std::size_t num_cells_since_start = 0;
};

/// Reads a journal that another process may be writing. Lines whose checksum is wrong and what a
/// kill cut short at the end are passed over. @throws IoError if it is no journal.
JournalContent read_journal(const std::filesystem::path& file);

/// Whether a process has the journal open for writing.
bool is_journal_in_use(const std::filesystem::path& file);

/// Finished cells on disk: a file to which one line per cell is appended and flushed before the
/// next cell counts. Every line starts with a checksum; a line that a kill cut short is dropped
/// when the file is opened again. One process at a time (the file is locked). In memory is only
/// where each line starts.
class CellJournal {
 public:
  /// @throws InvalidInput if the file was begun with another identity; IoError if it is no journal,
  /// another process keeps it open (waited for half a second: `is_journal_in_use` locks it for a
  /// moment) or it cannot be read or written.
  CellJournal(const std::filesystem::path& file, const JournalIdentity& identity,
              std::size_t num_cells);
  ~CellJournal();
  CellJournal(const CellJournal&) = delete;
  CellJournal& operator=(const CellJournal&) = delete;

  std::size_t num_cells() const { return content_.cells.size(); }
  bool has(std::size_t cell) const { return content_.cells[cell].is_final; }
  /// Whether there is any record of a cell, final or not.
  bool is_known(std::size_t cell) const { return content_.cells[cell].offset.has_value(); }
  /// Whether a cell's final record is of a failure.
  bool is_failed(std::size_t cell) const { return has(cell) && content_.cells[cell].is_failed; }
  const std::map<std::string, std::string>& inputs() const { return content_.inputs; }

  /// Records the hashes of the files that a run reads. Not while another thread appends.
  /// @throws InvalidInput, naming the file, if an earlier run had another in its place; IoError.
  void start_run(const std::map<std::string, std::string>& inputs);

  /// Appends the record of a cell, which is on disk on return. Safe to call from several threads.
  /// @throws IoError.
  void append(std::size_t cell, const std::string& key, const CellRecord& record);

  /// The last record of a cell that is known. @throws IoError. Not while another thread appends.
  CellRecord read(std::size_t cell) const;

  /// Takes over the cells of another journal of this identity that are missing here, and its
  /// inputs. On disk when it returns.
  /// @throws InvalidInput, naming cell or file, if both have a cell with other results, or the same
  /// input with other bytes; IoError.
  void absorb(const CellJournal& other);

 private:
  void open_and_lock();
  void check_header(const JournalIdentity& identity) const;
  std::string line_of(std::size_t cell) const;
  void write_line(const std::string& content);
  void flush_to_disk();
  [[noreturn]] void fail(const std::string& what) const;

  std::filesystem::path file_;
  int descriptor_ = -1;
  JournalContent content_;
  std::mutex mutex_;
};

}  // namespace graspfit::sweep::internal
