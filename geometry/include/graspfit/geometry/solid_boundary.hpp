#pragma once

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// Surface of the solid that a closed mesh means: where its winding number is not zero (see
/// `MeshQuery::containment`). So parts that overlap are united, an outward part inside another one
/// goes, an inward one stays as a cavity, and a surface that crosses itself is reduced to what
/// bounds the solid; all faces outward.
///
/// Faces are cut where they cross or touch; where is decided exactly, also for faces in one plane,
/// and so is which pieces stay. The corners of the pieces are rounded once, pieces that collapse by
/// it are dropped, and equal corners are one vertex. Faces that cross nothing stay as they are,
/// with vertices in the order of the mesh, after them the new ones. The result is closed (every
/// edge is run through as often up as down), but rounding may leave crossings of the size of an
/// ulp, and solids that touch share vertices and edges: `repair_mesh` splits those and tells.
///
/// Cost: that of counting self-intersections, and about a fifth of a millisecond for each pair of
/// faces that cross. A mesh without faces comes back.
/// @throws InvalidInput if the mesh is not closed in the sense above.
TriangleMesh solid_boundary(const TriangleMesh& mesh);

}  // namespace graspfit::geometry
