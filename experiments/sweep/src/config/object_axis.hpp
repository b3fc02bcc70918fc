#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/sweep/parameter_sweep.hpp"

namespace graspfit::sweep::internal {

/// Objects that every machine has: shapes in their own sizes and, where it is unpacked, a mesh of
/// libcgal-demo, 0.12 m long. Its size is left out if `has_sizes`: something else sets one then.
std::vector<AxisValue> default_objects(bool has_sizes);

/// Values of that axis that are meshes of the command line, as they are or scaled so that the
/// longest edge of the bounding box is `longest` [m]. A label is the file's name without its
/// ending, other characters than those of labels replaced by _; with a number where it is among
/// `taken` or given before.
/// @throws IoError, as `geometry::read_mesh`, for what is no file or no mesh; InvalidInput for a
/// path that is not UTF-8, which no manifest can hold.
std::vector<AxisValue> object_file_values(const std::vector<std::filesystem::path>& files,
                                          const std::optional<double>& longest,
                                          const std::vector<AxisValue>& taken);

}  // namespace graspfit::sweep::internal
