#pragma once

#include <filesystem>

namespace graspfit::base {

/// A mark in a folder whose files are being replaced one after the other: while it stands, files of
/// two runs may lie side by side. It is the file `.graspfit-replacing`, and stays if the program is
/// killed in between.

/// Sets the mark. @throws IoError with the system's reason alone.
void set_replacement_mark(const std::filesystem::path& folder);

/// Takes it away, if it is there. @throws IoError with the system's reason alone.
void remove_replacement_mark(const std::filesystem::path& folder);

/// @throws IoError if the folder in which `file` lies bears the mark.
void require_no_replacement_mark(const std::filesystem::path& file);

}  // namespace graspfit::base
