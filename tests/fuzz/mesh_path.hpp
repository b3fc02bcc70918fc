#pragma once

#include <string>
#include <string_view>

namespace graspfit::testing {

/// Processes a file's bytes all the way: reads, analyzes and repairs them, and voxelizes and
/// queries the mesh if it is small. `input` is one letter for the format (o OFF, b OBJ, p PLY, s
/// STL; any other counts as one of them) and the file.
///
/// Returns what became of it: a refusal in one line (`base::Error`) or "good". Any other exception
/// gets out, and so does std::logic_error where a result breaks its promise.
std::string take_mesh_path(std::string_view input);

}  // namespace graspfit::testing
