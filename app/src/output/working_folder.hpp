#pragma once

#include <filesystem>

namespace graspfit::app {

/// A new folder with a unique hidden name, which is removed with all its content when the object is
/// destroyed. While the object lives the folder is locked, which tells other processes that its
/// process lives.
class WorkingFolder {
 public:
  /// Makes the folder in `parent`, where folders that killed processes have left are removed first.
  /// @throws IoError with the system's reason alone.
  explicit WorkingFolder(const std::filesystem::path& parent);
  ~WorkingFolder();
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Removes the folder early. A second call does nothing.
  void remove();

  /// Renames the folder to `path`, where it stays. @throws IoError with the system's reason alone.
  void keep_as(const std::filesystem::path& path);

 private:
  std::filesystem::path path_;  ///< Empty: the folder was removed or renamed.
  int lock_ = -1;               ///< Descriptor of the folder, which holds its lock.
};

}  // namespace graspfit::app
