#pragma once

#include <filesystem>

namespace graspfit::hands::internal {

/// The folder that a description may refer to: that of the nearest package.xml above the file, or
/// else the file's own folder. Symbolic links resolved.
std::filesystem::path package_folder(const std::filesystem::path& description_file);

/// Whether a path is `folder` or below it, by their texts: both with symbolic links resolved.
bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace graspfit::hands::internal
