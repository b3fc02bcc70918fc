#include "graspfit/hands/hand_library.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/lies_in.hpp"
#include "graspfit/base/list_text.hpp"
#include "graspfit/base/nearest_name.hpp"
#include "graspfit/hands/hand_io.hpp"

namespace graspfit::hands {

namespace {

namespace fs = std::filesystem;

/// Folder of the running program; empty where the system does not say.
fs::path program_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : program.parent_path();
}

/// The value of GRASPFIT_HANDS; empty if it is not set.
std::string library_setting() {
  const char* const setting = std::getenv("GRASPFIT_HANDS");
  return setting == nullptr ? "" : setting;
}

/// Folders in which the hand library may be, best first. A program of the build tree uses the hands
/// of the source tree, so that a change there counts at once; an installed program uses the hands
/// beside it, wherever it was moved.
std::vector<fs::path> library_candidates() {
  if (const std::string setting = library_setting(); !setting.empty()) return {setting};
  std::vector<fs::path> candidates;
  if (const fs::path program = program_folder(); !program.empty()) {
    candidates.push_back(program.parent_path() / "share/graspfit/hands");
    if (base::lies_in(program, GRASPFIT_BUILD_FOLDER))
      candidates.emplace_back(GRASPFIT_SOURCE_HANDS);
  }
  candidates.emplace_back(GRASPFIT_INSTALLED_HANDS);
  candidates.emplace_back(GRASPFIT_SOURCE_HANDS);
  return candidates;
}

/// The folder of the hand library, if there is one.
std::optional<fs::path> found_library_folder() {
  std::error_code error;
  for (const fs::path& candidate : library_candidates()) {
    if (fs::is_directory(candidate, error)) return candidate;
  }
  return std::nullopt;
}

fs::path library_folder() {
  if (const auto folder = found_library_folder()) return *folder;
  if (const std::string setting = library_setting(); !setting.empty()) {
    throw base::InvalidInput("GRASPFIT_HANDS: " + setting + " is not a folder");
  }
  throw base::InvalidInput("no folder of shipped hands (looked in " +
                           library_candidates().front().string() + " and " +
                           GRASPFIT_INSTALLED_HANDS + "); set GRASPFIT_HANDS");
}

std::vector<std::string> hands_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (fs::is_regular_file(entry.path() / (name + ".urdf"), error)) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string list(const std::vector<std::string>& names) {
  return names.empty() ? "none" : base::list_text(names);
}

}  // namespace

std::vector<std::string> shipped_hands() { return hands_in(library_folder()); }

fs::path shipped_hand_file(const std::string& name) {
  const fs::path folder = library_folder();
  const std::vector<std::string> names = hands_in(folder);
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    throw base::InvalidInput("no shipped hand named " + name + "; there are " + list(names) +
                             base::did_you_mean(name, names));
  }
  return folder / name / (name + ".urdf");
}

fs::path path_in_library(const fs::path& file) {
  const auto folder = found_library_folder();
  if (!folder) return file;
  return base::lies_in(file, *folder) ? file.lexically_relative(*folder) : file;
}

fs::path find_hand_file(const std::string& name_or_file) {
  const fs::path path = name_or_file;
  std::error_code error;
  const bool is_file_name = path.has_parent_path() || path.has_extension();
  if (!is_file_name) {
    const std::vector<std::string> names = shipped_hands();
    if (std::find(names.begin(), names.end(), name_or_file) != names.end()) {
      return shipped_hand_file(name_or_file);
    }
    if (!fs::exists(path, error)) {
      throw base::InvalidInput("no hand " + name_or_file + ": shipped hands are " + list(names) +
                               "; or give the path of a URDF, MJCF or GraspIt! XML file" +
                               base::did_you_mean(name_or_file, names));
    }
  }
  return path;
}

HandModel find_hand(const std::string& name_or_file) {
  return read_hand_model(find_hand_file(name_or_file));
}

}  // namespace graspfit::hands
