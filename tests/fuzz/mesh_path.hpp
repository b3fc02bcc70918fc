#pragma once

#include <string>
#include <string_view>

namespace graspfit::testing {

/// Takes a file's bytes the whole way: read, analyzed, repaired, and if it is small, voxelized and
/// queried. `input` is one letter for the format (o OFF, b OBJ, p PLY, s STL; any other counts as
/// one of them) and the file.
///
/// Returns what came of it: a refusal in one line (`base::Error`) or "good". Any other
/// exception gets out, and so does std::logic_error where a result breaks its promise.
std::string take_mesh_path(std::string_view input);

}  // namespace graspfit::testing
