#pragma once

#include <filesystem>

namespace graspfit::base {

/// Who holds the lock of a file or folder that every process finds by its path.
enum class FileLock {
  Ours,         ///< We hold it, and the path still leads to the locked file.
  Others,       ///< Somebody else holds it, or has removed or replaced the file.
  Unavailable,  ///< The file system has no locks.
};

/// Locks the file or folder that is open as `descriptor` and was found at `path`, without waiting.
/// The lock lasts until the descriptor is closed, at the latest when the process ends: a file that
/// is not locked belongs to no living process.
FileLock lock_file(int descriptor, const std::filesystem::path& path);

}  // namespace graspfit::base
