#pragma once

#include <filesystem>
#include <string>

#include "cli/command_line.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/grasp/grasp_io.hpp"

namespace graspfit::app {

/// Adds --object, which says where a grasp file's object is today.
void add_object_flag(boost::program_options::options_description& options);

/// The object of the grasp file that the command names: from --object, from where the file says, or
/// from beside it. @throws IoError if it is in none of them or another one.
geometry::TriangleMesh load_recorded_object(const Flags& flags, const grasp::GraspFile& file);

/// The file's surroundings, their meshes looked for alike. @throws IoError as above.
grasp::Surroundings load_recorded_surroundings(const Flags& flags, const grasp::GraspFile& file);

}  // namespace graspfit::app
