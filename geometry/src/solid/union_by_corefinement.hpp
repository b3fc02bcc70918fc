#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry::internal {

/// Two faces, lower index first.
using FacePair = std::pair<std::int32_t, std::int32_t>;

/// The union of the parts of a mesh by CGAL's corefinement with exact points, which are rounded
/// once at the end; half the time of `solid_boundary`'s own cuts. As there, faces that
/// cross nothing stay as they are, the first of the result; the vertices of the mesh keep their
/// order, and new ones come after them, ascending.
///
/// Empty where the mesh is not for it: unless it has two or more parts, each a closed manifold
/// without crossings of its own that points outward and shares no vertex with another, some of them
/// cross, edges only through the inside of faces, and the surface of the union is a manifold. What
/// touches otherwise may make a union that touches itself, which corefinement does not take.
///
/// @param mesh faces with area, vertices with distinct coordinates
/// @param crossings pairs of faces that share more than corners and edges (`crossing_faces`)
std::optional<TriangleMesh> union_by_corefinement(const TriangleMesh& mesh,
                                                  std::span<const FacePair> crossings);

}  // namespace graspfit::geometry::internal
