#pragma once

#include <filesystem>

namespace graspfit::base {

/// A mark in a folder whose files are being replaced one after the other: while it is there, the
/// folder may hold files of two runs. It is the file `.graspfit-replacing`, and stays if the
/// program is killed in between.

/// Sets the mark. @throws IoError with the system's reason alone.
void set_replacement_mark(const std::filesystem::path& folder);

/// Removes the mark, if it is there. @throws IoError with the system's reason alone.
void remove_replacement_mark(const std::filesystem::path& folder);

/// @throws IoError if the folder in which `file` lies has the mark.
void require_no_replacement_mark(const std::filesystem::path& file);

}  // namespace graspfit::base
