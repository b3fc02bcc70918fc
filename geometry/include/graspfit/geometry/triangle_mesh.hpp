#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "graspfit/base/floating_point.hpp"
#include "graspfit/geometry/rigid_transform.hpp"

namespace graspfit::geometry {

/// A triangle of a mesh as indices of its vertices, counter-clockwise seen from outside.
using Face = std::array<std::int32_t, 3>;

/// An indexed triangle mesh: vertices in meters, faces counter-clockwise seen from outside.
///
/// A plain value. That the surface is closed, manifold or outward is a *checked* property
/// (`analyze`), never a promise of this type.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;  ///< Positions [m].
  std::vector<Face> faces;                ///< Indices into `vertices`.

  bool operator==(const TriangleMesh&) const = default;
};

/// The three corners of face `face`.
std::array<Eigen::Vector3d, 3> corners(const TriangleMesh& mesh, std::int32_t face);

/// Vector area of a face [m²]: along its outward normal, as long as its area. Zero for a
/// degenerate face. Rounded.
Eigen::Vector3d vector_area(const TriangleMesh& mesh, std::int32_t face);

/// Unit outward normal of a face; the zero vector where the face has no area. Rounded.
Eigen::Vector3d face_normal(const TriangleMesh& mesh, std::int32_t face);

/// Box of all vertices; empty for a mesh without vertices. Exact.
Eigen::AlignedBox3d bounding_box(const TriangleMesh& mesh);

/// Longest edge of the bounding box [m]; zero for a mesh without vertices.
double longest_extent(const TriangleMesh& mesh);

/// Sum of the face areas [m²]. Rounded.
double surface_area(const TriangleMesh& mesh);

/// The same mesh seen from frame A: every vertex mapped by `X_AB` and rounded once.
TriangleMesh transformed(const TriangleMesh& mesh_B, const RigidTransform& X_AB);

/// Every coordinate multiplied by `factor` (> 0, else InvalidInput).
TriangleMesh scaled(const TriangleMesh& mesh, double factor);

/// All meshes as one, in order; faces re-indexed, nothing merged.
TriangleMesh concatenated(const std::vector<TriangleMesh>& meshes);

}  // namespace graspfit::geometry
