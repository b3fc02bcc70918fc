#include "graspfit/geometry/used_vertices.hpp"

#include "mesh/input_check.hpp"

namespace graspfit::geometry {

std::vector<Eigen::Vector3d> used_vertices(const TriangleMesh& mesh) {
  internal::require_indices(mesh, "used_vertices");
  std::vector<bool> is_used(mesh.vertices.size(), false);
  for (const Face& face : mesh.faces) {
    for (const std::int32_t vertex : face) is_used[vertex] = true;
  }
  std::vector<Eigen::Vector3d> used;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (is_used[i]) used.push_back(mesh.vertices[i]);
  }
  return used;
}

}  // namespace graspfit::geometry
