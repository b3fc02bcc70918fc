#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/grasp/grasp_io.hpp"

namespace graspfit::app {

/// A file of grasps on one object.
struct SetFile {
  std::string path;
  grasp::GraspFile file;
  std::optional<geometry::TriangleMesh> mesh_O;  ///< Of another tool's grasps; ours name theirs.
};

/// Grasps on one or more objects.
struct GraspSet {
  std::string path;  ///< As given.
  std::vector<SetFile> files;
  std::vector<std::string> notes;  ///< For people, of grasps of another tool.
};

/// Reads a grasp file, every grasps.json in a folder and the folders below it (in the order of
/// their paths; hidden folders are passed over), or another tool's file as `import_file` does.
/// @throws UsageError, InvalidInput, IoError; for a folder without a grasps.json, too.
GraspSet read_grasp_set(const std::string& command, const Flags& flags, const std::string& path);

/// An object that two sets have grasps of, and the files that have them.
struct CommonObject {
  std::string name;  ///< Of its file, without folder and extension.
  std::array<std::vector<const SetFile*>, 2> files;
};

struct CommonObjects {
  std::vector<CommonObject> objects;  ///< In the order of the first set.
  std::vector<std::string> notes;     ///< Objects that one set alone has.
};

/// Objects are the same if their files have the same bytes and were read at the same size. The sets
/// must outlive the result. @throws InvalidInput if there is no common object.
CommonObjects common_objects(const GraspSet& a, const GraspSet& b);

}  // namespace graspfit::app
