#include "internal/data_files.hpp"

#include <cstdlib>
#include <system_error>

#include "graspfit/experiments/experiment.hpp"
#include "graspfit/experiments/experiment_config.hpp"
#include "graspfit/experiments/run_manifest.hpp"

namespace graspfit::experiments {
namespace {

namespace fs = std::filesystem;

bool lies_in(const fs::path& path, const fs::path& folder) {
  const fs::path relative = path.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != "..";
}

}  // namespace

fs::path source_folder() { return GRASPFIT_SOURCE_FOLDER; }

fs::path config_folder() {
  std::error_code error;
  if (const char* setting = std::getenv("GRASPFIT_EXPERIMENTS");
      setting != nullptr && *setting != '\0') {
    if (!fs::is_directory(setting, error)) {
      throw geometry::InvalidInput("GRASPFIT_EXPERIMENTS: " + std::string(setting) +
                                   " is not a folder");
    }
    return setting;
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path beside = program.parent_path().parent_path() / "share/graspfit/experiments";
  // A program of the build tree uses the sources' configurations, so that a change there counts.
  const fs::path sources = fs::path(GRASPFIT_SOURCE_FOLDER) / "experiments/configs";
  const fs::path installed = GRASPFIT_INSTALLED_CONFIGS;
  for (const fs::path& candidate : lies_in(program, GRASPFIT_BUILD_FOLDER)
                                       ? std::vector{sources, beside, installed}
                                       : std::vector{beside, installed, sources}) {
    if (fs::is_directory(candidate, error)) return candidate;
  }
  throw geometry::InvalidInput("no folder of configurations of experiments (looked in " +
                               beside.string() + " and " + installed.string() +
                               "); set GRASPFIT_EXPERIMENTS");
}

namespace internal {

fs::path data_folder() {
  const char* const setting = std::getenv("GRASPFIT_DATA");
  if (setting != nullptr && *setting != '\0') return setting;
  return source_folder().parent_path() / "shared";
}

fs::path data_file(const std::string& relative) {
  const fs::path file = data_folder() / relative;
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    throw MissingData(relative + " is not there; set GRASPFIT_DATA to the folder that holds it");
  }
  return file;
}

std::string name_of_input(const fs::path& file) {
  const fs::path path = fs::absolute(file).lexically_normal();
  const fs::path data = fs::absolute(data_folder()).lexically_normal();
  const fs::path sources = fs::absolute(source_folder()).lexically_normal();
  // In the root of a file system lies everything; elsewhere such names mean nothing.
  const bool has_data = data != data.root_path();
  if (has_data && lies_in(path, data)) return path.lexically_relative(data).string();
  if (!lies_in(path, sources)) return path.string();
  const fs::path relative = path.lexically_relative(sources);
  std::error_code error;
  const bool is_taken = has_data && fs::exists(data / relative, error);
  return (is_taken ? "sources" / relative : relative).string();
}

}  // namespace internal
}  // namespace graspfit::experiments
