#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "solid/mesh_holes.hpp"

/// \file
/// What a repair is made of. Each function changes the mesh and returns how many things it changed.

namespace graspfit::geometry::internal {

/// Vertices up to `distance` [m] apart become one; 0: those with equal coordinates. Returns how
/// many became another one, and the farthest way of one of them [m].
std::pair<std::size_t, double> weld(TriangleMesh& mesh, double distance);

/// Removes vertices of no face.
std::size_t remove_unused_vertices(TriangleMesh& mesh);

/// Faces with a repeated vertex bound nothing and go. Collinear faces with three vertices carry the
/// connection between their neighbors and stay: removing one would open the surface.
std::size_t remove_collapsed_faces(TriangleMesh& mesh);

/// What becomes of a surface of which every face has its opposite.
enum class TwoSided {
  Halved,  ///< It was drawn on both sides throughout: one of each pair stays.
  Removed  ///< It is a sheet without thickness.
};

/// Faces on the same three vertices cancel in pairs of opposite orientation; of those left one
/// stays.
std::size_t remove_doubled_faces(TriangleMesh& mesh, TwoSided two_sided);

/// Turns faces until neighbors over two-face edges agree, as the majority of each part is.
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
