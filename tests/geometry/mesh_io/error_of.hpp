#pragma once

#include <algorithm>
#include <filesystem>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "support/catch.hpp"

namespace graspfit::testing {

/// Returns what `read_mesh` says of a file after the file's name and `start`, in one line.
inline std::string error_of(const std::filesystem::path& file, const std::string& start = "") {
  try {
    geometry::read_mesh(file);
  } catch (const base::IoError& error) {
    const std::string text = error.what();
    CHECK(text.find('\n') == std::string::npos);
    const std::string prefix = "read_mesh: " + file.string() + ": " + start;
    CHECK(text.starts_with(prefix));
    return text.substr(std::min(prefix.size(), text.size()));
  }
  return "no error";
}

}  // namespace graspfit::testing
