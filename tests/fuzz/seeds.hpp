#pragma once

#include <string>
#include <vector>

namespace graspfit::testing {

/// An input of `take_mesh_path` from which fuzzing starts.
struct Seed {
  std::string name;
  std::string input;
};

/// Returns small solids, and small broken meshes, in every format that is read.
std::vector<Seed> seeds();

}  // namespace graspfit::testing
