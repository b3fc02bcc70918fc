#pragma once

#include <Eigen/Core>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// How volume integrals were summed.
enum class MassMethod {
  SignedSum,     ///< Summed over the mesh as it is.
  SolidBoundary  ///< Summed over the mesh's `solid_boundary`, so that overlaps count once.
};

/// Volume integrals of the solid bounded by a closed mesh, at density 1 kg/m³.
struct MassProperties {
  double volume = 0.0;             ///< [m³], positive for an outward mesh.
  Eigen::Vector3d center_of_mass;  ///< [m], in the frame of the mesh.
  Eigen::Matrix3d inertia;         ///< About the center of mass [kg·m² at 1 kg/m³].
  MassMethod method = MassMethod::SignedSum;
};

/// Volume, center of mass and inertia of the solid that a closed mesh means (the points around
/// which its winding number is not zero), by signed sums over tetrahedra with their apex at a
/// vertex. The sums are exact in real arithmetic and rounded here.
///
/// Parts (sets of faces connected by common vertices) whose boxes are disjoint, as in most meshes,
/// are summed as they are. Where boxes of parts meet, the sum runs over the boundary of the parts'
/// union, so that overlaps count once; `method` tells which of the two was done. A single part that
/// crosses itself, and a mesh that is not closed, are summed as they are: a region around which the
/// surface winds twice counts twice (it counts once if `solid_boundary` is applied first).
/// @throws InvalidInput if a coordinate is not finite or a face has a vertex that is none.
/// @throws DegenerateGeometry if the volume is not positive (open, inside-out or flat mesh).
MassProperties mass_properties(const TriangleMesh& mesh);

/// Sum of the signed volumes of the tetrahedra over all faces [m³]; this is the enclosed volume of
/// a closed outward mesh.
double signed_volume(const TriangleMesh& mesh);

/// Largest distance of a vertex of the mesh from `point` [m].
double largest_radius(const TriangleMesh& mesh, const Eigen::Vector3d& point);

}  // namespace graspfit::geometry
