#include "support/test_data.hpp"

#include <cstdlib>

namespace graspfit::testing {
namespace {

namespace fs = std::filesystem;

std::optional<fs::path> environment_path(const char* name) {
  const char* value = std::getenv(name);
  if (value == nullptr || *value == '\0') return std::nullopt;
  return fs::path(value);
}

std::optional<fs::path> existing_file(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  return path;
}

}  // namespace

fs::path source_directory() { return GRASPFIT_SOURCE_DIR; }

std::optional<fs::path> find_data(std::string_view relative_path) {
  const fs::path folder =
      environment_path("GRASPFIT_DATA").value_or(source_directory().parent_path() / "shared");
  return existing_file(folder / relative_path);
}

std::optional<fs::path> packaged_mesh(std::string_view file_name) {
  if (const auto folder = environment_path("GRASPFIT_PACKAGED_MESHES")) {
    return existing_file(*folder / file_name);
  }
  if (const auto cache = environment_path("XDG_CACHE_HOME")) {
    return existing_file(*cache / "graspfit/meshes" / file_name);
  }
  if (const auto home = environment_path("HOME")) {
    return existing_file(*home / ".cache/graspfit/meshes" / file_name);
  }
  return std::nullopt;
}

}  // namespace graspfit::testing
