#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace graspfit::experiments::internal {

/// What is kept of a finished cell: fields ready for CSV.
struct CellRecord {
  std::string status;  ///< "ok" or "failed".
  std::string reason;  ///< As a CSV field.
  std::vector<std::string> fields;
  std::vector<std::string> timings;
  std::vector<std::vector<std::string>> details;
};

/// Finished cells on disk: a file to which one line per cell is appended and flushed before the
/// next cell counts. Every line starts with a checksum; a line that a kill cut short is dropped
/// when the file is opened again. One process at a time (the file is locked). In memory is only
/// where each line starts.
class CellJournal {
 public:
  /// `identity` stands in the first line: what all cells of a file have in common.
  /// @throws InvalidInput if the file was begun with another identity, IoError if another process
  /// has it open or it cannot be read or written.
  CellJournal(const std::filesystem::path& file, const std::map<std::string, std::string>& identity,
              std::size_t num_cells);
  ~CellJournal();
  CellJournal(const CellJournal&) = delete;
  CellJournal& operator=(const CellJournal&) = delete;

  bool has(std::size_t cell) const { return offsets_[cell] >= 0; }
  /// On disk when it returns. Safe to call from several threads. @throws IoError.
  void append(std::size_t cell, const std::string& key, const CellRecord& record);
  /// @throws IoError. Not while another thread appends.
  CellRecord read(std::size_t cell) const;

 private:
  void open_and_lock();
  void load(const std::map<std::string, std::string>& identity);
  void write_line(const std::string& content);
  [[noreturn]] void fail(const std::string& what) const;

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::int64_t size_ = 0;
  std::vector<std::int64_t> offsets_;  ///< Per cell; −1 for cells that are not finished.
  std::mutex mutex_;
};

}  // namespace graspfit::experiments::internal
