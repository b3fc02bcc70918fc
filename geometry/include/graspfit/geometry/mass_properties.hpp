#pragma once

#include <Eigen/Core>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// Volume integrals of the solid bounded by a closed mesh, at density 1 kg/m³.
struct MassProperties {
  double volume = 0.0;             ///< [m³], positive for an outward mesh.
  Eigen::Vector3d center_of_mass;  ///< [m], in the frame of the mesh.
  Eigen::Matrix3d inertia;         ///< About the center of mass [kg·m² at 1 kg/m³].
};

/// Signed sums over tetrahedra from a vertex of the mesh. Rounded; exact in real arithmetic for a
/// closed mesh. Overlapping parts count as often as they overlap.
/// @throws DegenerateGeometry if the volume is not positive (open, inside-out or flat mesh).
MassProperties mass_properties(const TriangleMesh& mesh);

/// Sum of signed tetrahedra [m³]; the volume where the mesh is closed and outward.
double signed_volume(const TriangleMesh& mesh);

/// Largest distance of a vertex of the mesh from `point` [m].
double largest_radius(const TriangleMesh& mesh, const Eigen::Vector3d& point);

}  // namespace graspfit::geometry
