#pragma once

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry::internal {

/// Wraps the faces of a mesh and orients the wrap outward. `alpha_rel` and `offset_rel` are
/// relative to `extent`, the longest extent of the mesh [m]. The result has no faces if CGAL fails
/// or does not terminate.
TriangleMesh alpha_wrap(const TriangleMesh& given, double alpha_rel, double offset_rel,
                        double extent);

/// Whether all faces of `mesh` lie strictly inside the closed surface `wrap`. Exact.
bool encloses(const TriangleMesh& wrap, const TriangleMesh& mesh);

}  // namespace graspfit::geometry::internal
