#pragma once

#include <cstdint>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

/// \file
/// Holes of an open mesh: closed ways along edges with one face.

namespace graspfit::geometry::internal {

/// The rim of a hole: its vertices in the order in which faces to fill it run.
using HoleRim = std::vector<std::int32_t>;

/// Rims of a mesh's holes. Edges with one face that lead round no hole, as at an edge of three
/// faces, belong to none.
struct Holes {
  std::vector<HoleRim> meeting;  ///< Those that share a vertex with another hole, shortest first.
  std::vector<HoleRim> single;   ///< The others, by their lowest vertex.
};

/// Finds the rims. Holes that meet at vertices are told apart by the shortest ways around.
///
/// Where the border of a patch is subdivided and its neighbor's is not, patches hang together by
/// single vertices only:
///
///     ──┬───────┬───────┬──   coarse patch
///        ╲_._╱   ╲_._╱        cracks, each a hole of three sides
///     ──┴───┴───┴───┴───┴──   fine patch
///
/// From a vertex where cracks meet, the way along a patch's own border leads around the whole
/// patch, and the way across to the other patch around one crack. The cracks are the holes.
Holes holes_of(const TriangleMesh& mesh);

/// Longest edge of the box around a rim [m].
double rim_extent(const TriangleMesh& mesh, const HoleRim& rim);

/// Signed volume of the surface with every hole closed by a cone to the middle of its rim [m³]: a
/// measure of an open surface that does not depend on where it stands. Rounded.
double coned_volume(const TriangleMesh& mesh);

}  // namespace graspfit::geometry::internal
