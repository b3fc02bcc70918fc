#pragma once

#include <filesystem>

namespace graspfit::app {

/// A new folder with a hidden name that nobody else has, gone with all that is in it when the
/// object is. While it lives it is locked: by that, others know that its process does.
class WorkingFolder {
 public:
  /// In `parent`, where those that killed processes have left are removed first. @throws IoError
  /// with the system's reason alone.
  explicit WorkingFolder(const std::filesystem::path& parent);
  ~WorkingFolder();
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Before its time. Does nothing a second time.
  void remove();

  /// Gives it another name, under which it stays. @throws IoError with the system's reason alone.
  void keep_as(const std::filesystem::path& path);

 private:
  std::filesystem::path path_;  ///< Empty: it is gone, or has another name.
  int lock_ = -1;               ///< Descriptor; −1 where the file system locks nothing.
};

}  // namespace graspfit::app
