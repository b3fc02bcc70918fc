#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace graspfit::geometry {

/// Writes a file piece by piece so that a reader, a crash or a kill never sees half of it: to a
/// temporary name in the same folder, renamed over `file` by `commit`. Without `commit` nothing
/// happens to `file`. Memory holds one block, whatever the size of the file.
class AtomicFileWriter {
 public:
  /// @throws IoError (file and reason) if no file can be made there.
  explicit AtomicFileWriter(const std::filesystem::path& file);
  ~AtomicFileWriter();
  AtomicFileWriter(const AtomicFileWriter&) = delete;
  AtomicFileWriter& operator=(const AtomicFileWriter&) = delete;

  /// Appends. @throws IoError.
  void write(std::string_view content);

  /// Flushes to disk and renames. Nothing may be written afterwards. @throws IoError.
  void commit();

 private:
  void write_to_disk(std::string_view content);
  void flush();
  [[noreturn]] void fail(const std::string& what) const;

  std::filesystem::path file_;
  std::string temporary_;
  int descriptor_ = -1;
  std::string block_;  ///< Not on disk yet.
};

}  // namespace graspfit::geometry
