#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "solid/mesh_holes.hpp"

/// \file
/// The steps of a repair. Each function changes the mesh and returns how many elements it changed.

namespace graspfit::geometry::internal {

/// Welds vertices that are up to `distance` [m] apart; 0 welds vertices with equal coordinates.
/// Returns how many vertices were merged into another one, and the largest distance by which one of
/// them moved [m].
std::pair<std::size_t, double> weld(TriangleMesh& mesh, double distance);

/// Removes vertices of no face.
std::size_t remove_unused_vertices(TriangleMesh& mesh);

/// Removes faces with a repeated vertex, which bound nothing. Collinear faces with three vertices
/// connect their neighbors and stay: removing one would open the surface.
std::size_t remove_collapsed_faces(TriangleMesh& mesh);

/// What becomes of a surface in which every face has an opposite one on the same vertices.
enum class TwoSided {
  Halved,  ///< It was drawn on both sides throughout: one of each pair stays.
  Removed  ///< It is a sheet without thickness.
};

/// Faces on the same three vertices cancel in pairs of opposite orientation; of those left one
/// stays.
std::size_t remove_doubled_faces(TriangleMesh& mesh, TwoSided two_sided);

/// Turns faces until neighbors over two-face edges have the same orientation, that of the majority
/// of each part.
std::size_t make_consistent(TriangleMesh& mesh);

/// Gives every fan of faces around a vertex a vertex of its own. Around an edge with more than two
/// faces the two that bound the same wedge of solid stay together, so that solids which touch along
/// an edge come apart. Returns the vertices added.
std::size_t split_nonmanifold(TriangleMesh& mesh);

/// Fills those holes that are up to `largest_extent` [m]; the new faces come last. Returns how many
/// holes.
std::size_t fill_holes(TriangleMesh& mesh, const std::vector<HoleRim>& rims, double largest_extent);

/// Turns closed parts that are inside out. Returns how many parts.
std::size_t turn_inside_out_parts(TriangleMesh& mesh);

}  // namespace graspfit::geometry::internal
