#pragma once

#include <utility>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::testing {

inline void turn(geometry::TriangleMesh& mesh, std::size_t face) {
  std::swap(mesh.faces[face][1], mesh.faces[face][2]);
}

inline geometry::TriangleMesh inward(geometry::TriangleMesh mesh) {
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) turn(mesh, face);
  return mesh;
}

inline geometry::TriangleMesh moved(geometry::TriangleMesh mesh, const Eigen::Vector3d& by) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex += by;
  return mesh;
}

}  // namespace graspfit::testing
