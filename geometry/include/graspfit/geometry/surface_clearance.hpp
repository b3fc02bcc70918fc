#pragma once

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/rigid_transform.hpp"

namespace graspfit::geometry {

/// A lower bound of the distance d between two surfaces [m], for proofs that bodies stay apart: at
/// least min(share d, `enough`), at most min(d, `enough`), up to 1e-12 of the coordinates. Zero or
/// below rounding where the surfaces cross. Whether one body holds the other is not asked.
///
/// `share` in (0, 1] says how much of the distance is enough; 1 asks for all of it. Far cheaper
/// than `distance`: boxes alone bound what is left, and no exact decision is made.
double surface_clearance(const MeshQuery& a, const MeshQuery& b, const RigidTransform& X_AB,
                         double enough, double share);

}  // namespace graspfit::geometry
