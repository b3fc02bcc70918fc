#pragma once

#include <Eigen/Core>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// How volume integrals were summed.
enum class MassMethod {
  SignedSum,     ///< Over the mesh as it is.
  SolidBoundary  ///< Over `solid_boundary` of it: overlaps count once.
};

/// Volume integrals of the solid bounded by a closed mesh, at density 1 kg/m³.
struct MassProperties {
  double volume = 0.0;             ///< [m³], positive for an outward mesh.
  Eigen::Vector3d center_of_mass;  ///< [m], in the frame of the mesh.
  Eigen::Matrix3d inertia;         ///< About the center of mass [kg·m² at 1 kg/m³].
  MassMethod method = MassMethod::SignedSum;
};

/// Volume, center of mass and inertia of the solid that a closed mesh means (its winding number is
/// not zero), by signed sums over tetrahedra from a vertex. Rounded; in real arithmetic exact.
///
/// Parts (faces that hang together by common vertices) whose boxes are apart, as of most meshes,
/// are summed as they are. Where boxes of parts meet, the sum runs over the boundary of their
/// union, so that what overlaps counts once; `method` says so. A single part that crosses itself,
/// and a mesh that is not closed, is summed as it is: what it winds around twice counts twice
/// (`solid_boundary` and then this function count it once).
/// @throws DegenerateGeometry if the volume is not positive (open, inside-out or flat mesh).
MassProperties mass_properties(const TriangleMesh& mesh);

/// Sum of signed tetrahedra [m³]; the volume where the mesh is closed and outward.
double signed_volume(const TriangleMesh& mesh);

/// Largest distance of a vertex of the mesh from `point` [m].
double largest_radius(const TriangleMesh& mesh, const Eigen::Vector3d& point);

}  // namespace graspfit::geometry
