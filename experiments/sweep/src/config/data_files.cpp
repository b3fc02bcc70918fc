#include "graspfit/sweep/data_files.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <vector>

#include "graspfit/base/lies_in.hpp"
#include "graspfit/base/sha256.hpp"
#include "graspfit/sweep/experiment.hpp"
#include "graspfit/sweep/experiment_config.hpp"

namespace graspfit::sweep {
namespace {

namespace fs = std::filesystem;

/// A mesh of the data folder and the packaged mesh of the same bytes.
struct Twin {
  std::string_view file;
  std::string_view packaged;
  std::string_view sha256;
};

constexpr std::array kTwins = {
    Twin{"meshes/paper/armadillo.off", "armadillo.off",
         "6f7f3ca1abc506569466b72f2f59d49493a284e7376d7a7e23c08115ec8cec4e"},
    Twin{"meshes/paper/bunny.off", "bunny00.off",
         "ab651cb04955c161efaeb079035a1e5e1f0e0d1f816a2df67beaea68f393ff2b"},
    Twin{"meshes/paper/dinosaur.off", "dino.off",
         "acca16a64f425dd705375ada71ed4cf046beb2a1a06629a3c2325bb0530475db"},
    Twin{"meshes/paper/teddy.off", "bear.off",
         "058f6ce62635e5f86958adea9706a8dca3ebe4fae76a0d32b8318d107d40bda6"},
};

const Twin* find_twin(const std::string& relative) {
  const auto found = std::find_if(kTwins.begin(), kTwins.end(),
                                  [&](const Twin& twin) { return twin.file == relative; });
  return found == kTwins.end() ? nullptr : found;
}

/// The value of an environment variable; none if it is empty, too.
std::optional<fs::path> environment_folder(const char* name) {
  const char* const value = std::getenv(name);
  if (value == nullptr || *value == '\0') return std::nullopt;
  return fs::path(value);
}

/// Folders that are searched for packaged meshes: as `fetch_meshes` of setup/setup.sh, which puts
/// them into the build folder where the user has no cache folder.
std::vector<fs::path> packaged_mesh_folders() {
  if (const auto folder = environment_folder("GRASPFIT_PACKAGED_MESHES")) return {*folder};
  std::vector<fs::path> folders;
  if (const auto cache = environment_folder("XDG_CACHE_HOME")) {
    folders.push_back(*cache / "graspfit/meshes");
  } else if (const auto home = environment_folder("HOME")) {
    folders.push_back(*home / ".cache/graspfit/meshes");
  }
  folders.push_back(source_folder() / "build/cache/meshes");
  return folders;
}

std::optional<fs::path> existing_file(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  return file;
}

}  // namespace

fs::path source_folder() { return GRASPFIT_SOURCE_FOLDER; }

fs::path config_folder() {
  std::error_code error;
  if (const char* setting = std::getenv("GRASPFIT_EXPERIMENTS");
      setting != nullptr && *setting != '\0') {
    if (!fs::is_directory(setting, error)) {
      throw base::InvalidInput("GRASPFIT_EXPERIMENTS: " + std::string(setting) +
                               " is not a folder");
    }
    return setting;
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path beside = program.parent_path().parent_path() / "share/graspfit/experiments";
  // A program of the build tree uses the sources' configurations, so that a change there counts.
  const fs::path sources = fs::path(GRASPFIT_SOURCE_FOLDER) / "experiments/configs";
  const fs::path installed = GRASPFIT_INSTALLED_CONFIGS;
  for (const fs::path& candidate : base::lies_in(program, GRASPFIT_BUILD_FOLDER)
                                       ? std::vector{sources, beside, installed}
                                       : std::vector{beside, installed, sources}) {
    if (fs::is_directory(candidate, error)) return candidate;
  }
  throw base::InvalidInput("no folder of configurations of experiments (looked in " +
                           beside.string() + " and " + installed.string() +
                           "); set GRASPFIT_EXPERIMENTS");
}

fs::path data_folder() {
  return environment_folder("GRASPFIT_DATA").value_or(source_folder().parent_path() / "shared");
}

std::optional<std::string> packaged_twin(const std::string& relative) {
  const Twin* const twin = find_twin(relative);
  return twin == nullptr ? std::nullopt : std::optional(std::string(twin->packaged));
}

std::optional<fs::path> find_packaged_mesh(const std::string& name) {
  for (const fs::path& folder : packaged_mesh_folders()) {
    if (const auto file = existing_file(folder / name)) return file;
  }
  return std::nullopt;
}

fs::path packaged_mesh(const std::string& name) {
  if (const auto file = find_packaged_mesh(name)) return *file;
  throw MissingData(name + " of libcgal-demo is not there; ./quickstart unpacks it, or set " +
                    "GRASPFIT_PACKAGED_MESHES to the folder that holds it");
}

std::optional<fs::path> find_data_file(const std::string& relative) {
  if (const auto file = existing_file(data_folder() / relative)) return file;
  const Twin* const twin = find_twin(relative);
  if (twin == nullptr) return std::nullopt;
  const auto file = find_packaged_mesh(std::string(twin->packaged));
  // Another version of the package may have another mesh under that name.
  if (!file || base::sha256_of_file(*file) != twin->sha256) return std::nullopt;
  return file;
}

fs::path data_file(const std::string& relative) {
  if (const auto file = find_data_file(relative)) return *file;
  throw MissingData(relative + " is not there" +
                    (fs::path(relative).is_absolute()
                         ? " any more"
                         : "; set GRASPFIT_DATA to the folder that holds it"));
}

std::string name_of_input(const fs::path& file) {
  const fs::path path = fs::absolute(file).lexically_normal();
  const fs::path data = fs::absolute(data_folder()).lexically_normal();
  const fs::path sources = fs::absolute(source_folder()).lexically_normal();
  // All files lie in the root of a file system, so that names relative to it would mean nothing
  // elsewhere.
  const bool has_data = data != data.root_path();
  if (has_data && base::lies_in(path, data)) return path.lexically_relative(data).string();
  for (const fs::path& folder : packaged_mesh_folders()) {
    const fs::path meshes = fs::absolute(folder).lexically_normal();
    if (meshes != meshes.root_path() && base::lies_in(path, meshes)) {
      return ("packaged" / path.lexically_relative(meshes)).string();
    }
  }
  if (!base::lies_in(path, sources)) return path.string();
  const fs::path relative = path.lexically_relative(sources);
  std::error_code error;
  const bool is_taken = has_data && fs::exists(data / relative, error);
  return (is_taken ? "sources" / relative : relative).string();
}

}  // namespace graspfit::sweep
