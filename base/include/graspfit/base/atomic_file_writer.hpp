#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace graspfit::base {

/// Writes a file piece by piece so that a reader, a crash or a kill never sees half of it: to a
/// temporary name in the same folder, renamed over `file` by `commit`. Without `commit` nothing
/// happens to `file`. Memory holds one block, whatever the size of the file. What a killed writer
/// has left under a temporary name (`FILE.part0`) is taken over by the next one of the same file.
///
/// A symbolic link stays: what it leads to is written in that way. Pipes, character devices and
/// what `/dev/stdout` and its like stand for cannot be replaced; the pieces go into them as they
/// come, and opening a pipe waits for its reader. Folders, block devices and sockets are refused.
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

  std::filesystem::path file_;      ///< As the caller names it.
  std::filesystem::path replaced_;  ///< What `commit` renames over: `file_` behind its links.
  std::string temporary_;           ///< Empty: the pieces go into what is there.
  int descriptor_ = -1;
  std::string block_;  ///< Not on disk yet.
};

}  // namespace graspfit::base
