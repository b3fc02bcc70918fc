#include "decomposition/outside_depth.hpp"

#include <algorithm>
#include <cmath>

#include "query/indexed_triangle.hpp"
#include "solid/mesh_edges.hpp"

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3d;

// Normals at the surface point nearest to a query point, which tell whether the latter is inside or
// outside: the normal of the face, at an edge the sum of both faces' normals, at a vertex the sum
// weighted by angle [Bærentzen & Aanæs 2005].
std::vector<Vector3d> vertex_normals_of(const TriangleMesh& mesh) {
  std::vector<Vector3d> normals(mesh.vertices.size(), Vector3d::Zero());
  for (std::int32_t f = 0; f < std::ssize(mesh.faces); ++f) {
    const Vector3d normal = face_normal(mesh, f);
    const std::array<Vector3d, 3> p = corners(mesh, f);
    for (int k = 0; k < 3; ++k) {
      const Vector3d a = p[(k + 1) % 3] - p[k];
      const Vector3d b = p[(k + 2) % 3] - p[k];
      normals[mesh.faces[f][k]] += std::atan2(a.cross(b).norm(), a.dot(b)) * normal;
    }
  }
  return normals;
}

std::vector<std::array<Vector3d, 3>> edge_normals_of(const TriangleMesh& mesh) {
  std::vector<std::array<Vector3d, 3>> normals(
      mesh.faces.size(), {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()});
  for_each_edge(sorted_sides(mesh), [&](auto first, auto last) {
    Vector3d sum = Vector3d::Zero();
    for (auto side = first; side != last; ++side) sum += face_normal(mesh, side->face);
    for (auto side = first; side != last; ++side) normals[side->face][side->corner] = sum;
  });
  return normals;
}

}  // namespace

OutsideDepth::OutsideDepth(const MeshQuery& solid, int resolution)
    : solid_(solid),
      mesh_(&solid.mesh()),
      lattice_(lattice_around(solid.box(), {.resolution = resolution})),
      nearest_faces_(lattice_.num_voxels(), -1),
      edge_normals_(edge_normals_of(solid.mesh())),
      vertex_normals_(vertex_normals_of(solid.mesh())) {
  face_normals_.reserve(mesh_->faces.size());
  face_corners_.reserve(mesh_->faces.size());
  for (std::int32_t f = 0; f < std::ssize(mesh_->faces); ++f) {
    face_normals_.push_back(face_normal(*mesh_, f));
    face_corners_.push_back(corners(*mesh_, f));
  }
}

double OutsideDepth::operator()(const Vector3d& point) const {
  const Eigen::Vector3i voxel =
      lattice_.voxel_at(point).cwiseMax(0).cwiseMin((lattice_.counts.array() - 1).matrix());
  std::int32_t& face = nearest_faces_[lattice_.index(voxel)];
  if (face < 0) face = solid_.closest_point(lattice_.center(voxel)).face;
  const TrianglePoint nearest = nearest_on_triangle(point, face_corners_[face]);
  const Vector3d away = point - nearest.point;
  int num_zero = 0;
  int zero = -1;
  int nonzero = -1;
  for (int k = 0; k < 3; ++k) {
    if (nearest.barycentric[k] > 0.0) {
      nonzero = k;
    } else {
      ++num_zero;
      zero = k;
    }
  }
  const Vector3d& normal = num_zero == 0   ? face_normals_[face]
                           : num_zero == 1 ? edge_normals_[face][(zero + 1) % 3]
                                           : vertex_normals_[mesh_->faces[face][nonzero]];
  return normal.dot(away) > 0.0 ? away.norm() : 0.0;
}

}  // namespace graspfit::geometry::internal
