#include "graspfit/geometry/triangle_mesh.hpp"

#include <cmath>
#include <string>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"

namespace graspfit::geometry {

std::array<Eigen::Vector3d, 3> corners(const TriangleMesh& mesh, std::int32_t face) {
  const Face& f = mesh.faces[face];
  return {mesh.vertices[f[0]], mesh.vertices[f[1]], mesh.vertices[f[2]]};
}

Eigen::Vector3d vector_area(const TriangleMesh& mesh, std::int32_t face) {
  const auto [a, b, c] = corners(mesh, face);
  return 0.5 * (b - a).cross(c - a);
}

Eigen::Vector3d face_normal(const TriangleMesh& mesh, std::int32_t face) {
  return vector_area(mesh, face).stableNormalized();
}

Eigen::AlignedBox3d bounding_box(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  return box;
}

double longest_extent(const TriangleMesh& mesh) {
  return mesh.vertices.empty() ? 0.0 : bounding_box(mesh).sizes().maxCoeff();
}

double surface_area(const TriangleMesh& mesh) {
  double area = 0.0;
  for (std::int32_t face = 0; face < std::ssize(mesh.faces); ++face) {
    area += vector_area(mesh, face).norm();
  }
  return area;
}

TriangleMesh transformed(const TriangleMesh& mesh_B, const RigidTransform& X_AB) {
  TriangleMesh mesh_A = mesh_B;
  for (Eigen::Vector3d& vertex : mesh_A.vertices) vertex = X_AB * vertex;
  return mesh_A;
}

TriangleMesh scaled(const TriangleMesh& mesh, double factor) {
  if (!(factor > 0.0) || !std::isfinite(factor)) {
    throw base::InvalidInput("scaled: factor is " + std::to_string(factor) + ", must be positive");
  }
  TriangleMesh result = mesh;
  for (Eigen::Vector3d& vertex : result.vertices) vertex *= factor;
  return result;
}

TriangleMesh concatenated(const std::vector<TriangleMesh>& meshes) {
  TriangleMesh result;
  for (const TriangleMesh& mesh : meshes) {
    const auto first = base::as_index<std::int32_t>(result.vertices.size());
    result.vertices.insert(result.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const Face& f : mesh.faces) {
      result.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
    }
  }
  return result;
}

}  // namespace graspfit::geometry
