#pragma once

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry::internal {

/// Wraps the faces and orients the wrap outward; alpha and offset over `extent`, the longest of the
/// mesh [m]. No faces if CGAL does not come to a good end.
TriangleMesh alpha_wrap(const TriangleMesh& given, double alpha_rel, double offset_rel,
                        double extent);

/// Whether all faces of `mesh` lie strictly inside the closed surface `wrap`. Exact.
bool encloses(const TriangleMesh& wrap, const TriangleMesh& mesh);

}  // namespace graspfit::geometry::internal
