#pragma once

#include <filesystem>
#include <vector>

namespace graspfit::base {

/// Whether a path is `folder` or below it. Only the texts are compared, so links within them, and
/// `..` that stands after one, are to be resolved before. False where one of them is absolute and
/// the other is not.
bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder);

/// Whether a path is any of several folders, or below one.
bool lies_in(const std::filesystem::path& path, const std::vector<std::filesystem::path>& folders);

}  // namespace graspfit::base
