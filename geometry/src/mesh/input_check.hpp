#pragma once

#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"

/// \file
/// What is refused at the doors by which meshes and poses come in, before anything is computed:
/// CGAL and sorting by coordinates have no answer for numbers that are not finite.

namespace graspfit::geometry::internal {

/// @throws InvalidInput "<who>: vertex 7 is not finite" or "<who>: face 3 has vertex 9 of 8", for
/// the first of either, unused vertices included.
void require_usable(const TriangleMesh& mesh, const char* who);

/// As `require_usable`, but of the faces' indices alone.
void require_indices(const TriangleMesh& mesh, const char* who);

/// @throws InvalidInput "<who>: the pose is not finite".
void require_finite(const RigidTransform& pose, const char* who);

}  // namespace graspfit::geometry::internal
