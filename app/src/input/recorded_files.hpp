#pragma once

#include <filesystem>
#include <string>

#include "cli/command_line.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"
#include "graspfit/grasp/grasp_io.hpp"

namespace graspfit::app {

/// Adds --object, the present path of a grasp file's object.
void add_object_flag(boost::program_options::options_description& options);

/// Reads the object of the grasp file at `grasp_file`: from --object, else from the recorded path,
/// else from beside the grasp file. @throws IoError if the file is at none of these, or has another
/// object.
geometry::TriangleMesh load_recorded_object(const Flags& flags, const grasp::GraspFile& file,
                                            const std::filesystem::path& grasp_file);

/// The same for the grasp file that the command names.
geometry::TriangleMesh load_recorded_object(const Flags& flags, const grasp::GraspFile& file);

/// Reads the surroundings of the grasp file at `grasp_file`; their meshes are searched for at the
/// recorded path, then beside the grasp file. @throws IoError as `load_recorded_object`.
grasp::Surroundings load_recorded_surroundings(const grasp::GraspFile& file,
                                               const std::filesystem::path& grasp_file);

}  // namespace graspfit::app
