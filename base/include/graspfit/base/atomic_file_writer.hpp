#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace graspfit::base {

/// Writes a file piece by piece so that nobody ever reads half of it, even after a crash or a kill:
/// the pieces go to a temporary file in the same folder, which `commit` renames to `file`. Without
/// `commit` nothing happens to `file`. Memory holds one block, whatever the size of the file. A
/// temporary file that a killed writer has left (`FILE.part0`) is taken over by the next writer of
/// the same file.
///
/// A symbolic link stays: the file that it leads to is written in this way. Pipes, character
/// devices and the open files that `/dev/stdout` and the like stand for cannot be replaced; the
/// pieces are written to them as they come, and opening a pipe waits for its reader. Folders, block
/// devices and sockets are refused.
class AtomicFileWriter {
 public:
  /// @throws IoError (file and reason) if no file can be made there.
  explicit AtomicFileWriter(const std::filesystem::path& file);
  ~AtomicFileWriter();
  AtomicFileWriter(const AtomicFileWriter&) = delete;
  AtomicFileWriter& operator=(const AtomicFileWriter&) = delete;

  /// Appends `content`. @throws IoError.
  void write(std::string_view content);

  /// Flushes to disk and renames. Nothing may be written afterwards. @throws IoError.
  void commit();

 private:
  void write_to_disk(std::string_view content);
  void flush();
  [[noreturn]] void fail(const std::string& what) const;

  std::filesystem::path file_;      ///< The path that the caller gave.
  std::filesystem::path replaced_;  ///< What `commit` replaces: `file_`, links followed.
  std::string temporary_;           ///< Temporary file; empty: `file_` is written to directly.
  int descriptor_ = -1;
  std::string block_;  ///< The bytes that are not on disk yet.
};

}  // namespace graspfit::base
