#pragma once

#include <filesystem>

namespace graspfit::base {

/// Who has the lock of a file or folder that every process finds by its name.
enum class FileLock {
  Ours,         ///< And the name still leads to what is locked: nobody has removed it meanwhile.
  Others,       ///< Somebody else has it, or has removed or replaced what was opened.
  Unavailable,  ///< The file system locks nothing.
};

/// Locks what is open as `descriptor` and was found at `path`, without waiting. The lock lasts
/// until the descriptor is closed, at the latest when the process ends: what is not locked belongs
/// to nobody that lives.
FileLock lock_file(int descriptor, const std::filesystem::path& path);

}  // namespace graspfit::base
