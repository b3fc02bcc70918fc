#pragma once

#include <string>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::testing {

/// A mesh with a defect, or one that only looks as if it had one.
struct BrokenMesh {
  std::string name;   ///< As in `assets/broken_mesh_outcomes.csv`.
  std::string wrong;  ///< What is wrong with it, in words.
  geometry::TriangleMesh mesh;
};

/// Returns all of them, built in code. What becomes of each is written in
/// `assets/broken_mesh_outcomes.csv`, from the contract of `repair_mesh` and not from its answers.
///
/// *Cube* is [0, 1]³ and *tall* is [0, 1] × [0, 1] × [0, 4], both of 12 faces, in meters.
std::vector<BrokenMesh> broken_meshes();

}  // namespace graspfit::testing
