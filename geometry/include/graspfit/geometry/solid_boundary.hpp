#pragma once

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// Surface of the solid that a closed mesh means: where its winding number is not zero (see
/// `MeshQuery::containment`). Thus parts that overlap are united, an outward part inside another
/// one is removed, an inward part stays as a cavity, and a surface that crosses itself is reduced
/// to what bounds the solid. All faces point outward.
///
/// Faces are cut where they cross or touch. The cuts, also those of coplanar faces, and the choice
/// of the pieces that stay are exact. The corners of the pieces are rounded once, pieces that
/// collapse by rounding are dropped, and equal corners become one vertex. Faces that cross nothing
/// stay as they are; the vertices of the mesh keep their order, and new ones come after them. The
/// result is closed (every edge is run through as often up as down), but rounding may leave
/// crossings of the size of an ulp, and solids that touch share vertices and edges, which
/// `repair_mesh` splits and reports.
///
/// Cost: that of counting self-intersections, and about a fifth of a millisecond for each pair of
/// faces that cross; half of that where 500 and more pairs cross, all of them between clean parts
/// and edges through the inside of faces only, which CGAL's corefinement unites. A mesh without
/// faces gives one without faces.
/// @throws InvalidInput if the mesh is not closed in the sense above, a coordinate is not finite or
/// a face has a vertex that is none.
TriangleMesh solid_boundary(const TriangleMesh& mesh);

}  // namespace graspfit::geometry
