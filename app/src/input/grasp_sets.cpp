#include "input/grasp_sets.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/list_text.hpp"
#include "graspfit/base/number_text.hpp"
#include "input/imported_files.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;

/// Largest share by which sizes of one object differ: what another tool states in single precision.
constexpr double kSameSize = 1e-6;

constexpr const char* kGraspFileName = "grasps.json";

std::vector<fs::path> grasp_files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  fs::recursive_directory_iterator at(folder, error);
  for (; !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (name.starts_with('.')) {
      // Folders of a run that is not done.
      at.disable_recursion_pending();
    } else if (name == kGraspFileName) {
      files.push_back(at->path());
    }
  }
  if (error) throw base::IoError(folder.string() + ": cannot be searched: " + error.message());
  if (files.empty()) {
    throw base::IoError(folder.string() + ": no " + kGraspFileName +
                        " in this folder nor in those below it");
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string object_name(const grasp::ObjectRecord& object) {
  return fs::path(object.file).stem().string();
}

bool is_same_object(const grasp::ObjectRecord& a, const grasp::ObjectRecord& b) {
  return a.sha256 == b.sha256 && std::abs(a.meters_per_file_unit - b.meters_per_file_unit) <=
                                     kSameSize * a.meters_per_file_unit;
}

/// The object of that record among those found so far, or a new one.
CommonObject& object_of(const grasp::ObjectRecord& record, std::vector<CommonObject>& objects) {
  for (CommonObject& object : objects) {
    const SetFile* first = object.files[object.files[0].empty() ? 1 : 0].front();
    if (is_same_object(first->file.object, record)) return object;
  }
  return objects.emplace_back(CommonObject{object_name(record), {}});
}

/// "only A has mug; left out", with why an object of the same name is another one.
std::string left_out_text(const CommonObject& alone, const std::vector<CommonObject>& objects) {
  const std::size_t side = alone.files[0].empty() ? 1 : 0;
  std::string text = std::string("only ") + (side == 0 ? "A" : "B") + " has grasps of " +
                     alone.name + ", which are left out";
  for (const CommonObject& other : objects) {
    if (other.name != alone.name || other.files[1 - side].empty()) continue;
    const grasp::ObjectRecord& mine = alone.files[side].front()->file.object;
    const grasp::ObjectRecord& theirs = other.files[1 - side].front()->file.object;
    text += mine.sha256 != theirs.sha256
                ? "; the other's " + alone.name + " is another file (SHA-256)"
                : "; the other's is of another size (" +
                      base::shortest_decimal(theirs.meters_per_file_unit) + ", not " +
                      base::shortest_decimal(mine.meters_per_file_unit) +
                      " m per unit of its file)";
    break;
  }
  return text;
}

/// Puts the longest edge of their boxes behind the names of objects that share one.
void tell_apart(std::vector<CommonObject>& objects) {
  std::map<std::string, int> counts;
  for (const CommonObject& object : objects) ++counts[object.name];
  for (CommonObject& object : objects) {
    if (counts[object.name] < 2) continue;
    const Eigen::AlignedBox3d& box = object.files[0].front()->file.object.analysis.box;
    object.name += " (" + base::plain_decimal(std::round(1000.0 * box.sizes().maxCoeff())) + " mm)";
  }
}

}  // namespace

GraspSet read_grasp_set(const std::string& command, const Flags& flags, const std::string& path) {
  GraspSet set;
  set.path = path;
  std::error_code error;
  if (fs::is_directory(path, error)) {
    for (const fs::path& file : grasp_files_in(path)) {
      set.files.push_back({file.string(), grasp::read_grasps(file), {}});
    }
  } else if (is_importable(path)) {
    ImportedFile imported = import_file(command, flags, path);
    set.files.push_back({path, std::move(imported.file), std::move(imported.mesh_O)});
    set.notes = std::move(imported.notes);
  } else {
    set.files.push_back({path, grasp::read_grasps(path), {}});
  }
  return set;
}

CommonObjects common_objects(const GraspSet& a, const GraspSet& b) {
  std::vector<CommonObject> all;
  for (const GraspSet* set : {&a, &b}) {
    for (const SetFile& file : set->files) {
      object_of(file.file.object, all).files[set == &a ? 0 : 1].push_back(&file);
    }
  }
  CommonObjects common;
  for (const CommonObject& object : all) {
    if (object.files[0].empty() || object.files[1].empty()) {
      common.notes.push_back(left_out_text(object, all));
    } else {
      common.objects.push_back(object);
    }
  }
  tell_apart(common.objects);
  if (common.objects.empty()) {
    throw base::InvalidInput(
        "A and B have no object in common, by the bytes of its file and its "
        "size: " +
        base::list_text(common.notes, {}, "; "));
  }
  return common;
}

}  // namespace graspfit::app
