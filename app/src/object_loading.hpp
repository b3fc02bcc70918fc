#pragma once

#include <boost/program_options/options_description.hpp>
#include <string>

#include "command_line.hpp"
#include "graspfit/grasp/object_file.hpp"

namespace graspfit::app {

/// The flags that say how an object's file becomes a solid in meters.
boost::program_options::options_description object_options();

/// What those flags say. @throws UsageError, InvalidInput.
grasp::ObjectReadOptions object_read_options(const Flags& flags);

/// Reads the object that the command names.
grasp::ObjectFile load_object(const Flags& flags);

/// Throws InvalidInput unless the object's surface is closed and faces outward (a mesh that was
/// left as it is may not).
void require_solid(const grasp::ObjectFile& object);

/// "0.15 x 0.148 x 0.116 m", rounded to a micrometer.
std::string extents_text(const geometry::TriangleMesh& mesh);

}  // namespace graspfit::app
