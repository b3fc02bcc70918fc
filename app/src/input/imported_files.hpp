#pragma once

#include <boost/program_options/options_description.hpp>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/grasp/grasp_io.hpp"

namespace graspfit::app {

/// The flags for grasps whose file has neither hand nor object, but for --object, and with those of
/// `object_options`.
boost::program_options::options_description import_options();

/// Throws UsageError "--FLAG WHY" for the first flag of `import_options` that is given.
void refuse_import_flags(const Flags& flags, const std::string& why);

/// Whether a file is one of another tool that is read, by its extension.
bool is_importable(const std::string& file);

/// Another tool's grasps, measured as ours are.
struct ImportedFile {
  grasp::GraspFile file;
  geometry::TriangleMesh mesh_O;
  std::vector<std::string> names;  ///< Name of each grasp of `file`.
  std::vector<std::string> notes;  ///< For people.
};

/// Reads isaac_grasp (.yaml) or DexGraspBench's arrays (.npz) by --hand, --object and
/// `import_options`. Where an NPZ file states the object's scale and no flag does, that scale is
/// taken. `command` is the program's, for what is printed of the hand. @throws UsageError,
/// InvalidInput, IoError.
ImportedFile import_file(const std::string& command, const Flags& flags, const std::string& file);

}  // namespace graspfit::app
