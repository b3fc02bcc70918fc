#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/sweep/parameter_sweep.hpp"

namespace graspfit::sweep::internal {

/// Objects that every machine has: shapes in their own sizes and, where it is unpacked, a mesh of
/// libcgal-demo, 0.12 m long. This length is left out if `has_sizes` says that something else sets
/// one.
std::vector<AxisValue> default_objects(bool has_sizes);

/// Makes values of the axis of objects from meshes of the command line, as they are or scaled so
/// that the longest edge of the bounding box is `longest` [m]. A label is the file's name without
/// its ending, with _ for characters that labels cannot have, and with a number where it is among
/// `taken` or was given before.
/// @throws IoError, as `geometry::read_mesh`, for what is no file or no mesh; InvalidInput for a
/// path that is not UTF-8, which no manifest can hold.
std::vector<AxisValue> object_file_values(const std::vector<std::filesystem::path>& files,
                                          const std::optional<double>& longest,
                                          const std::vector<AxisValue>& taken);

}  // namespace graspfit::sweep::internal
