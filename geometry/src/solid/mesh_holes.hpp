#pragma once

#include <cstdint>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

/// \file
/// Holes of an open mesh: closed loops of edges with one face.

namespace graspfit::geometry::internal {

/// The rim of a hole: its vertices in the order in which faces to fill it run.
using HoleRim = std::vector<std::int32_t>;

/// Rims of a mesh's holes. Edges with one face that are on no closed loop, as at an edge of three
/// faces, belong to no rim.
struct Holes {
  std::vector<HoleRim> meeting;  ///< Those that share a vertex with another hole, shortest first.
  std::vector<HoleRim> single;   ///< The others, by their lowest vertex.
};

/// Finds the rims. Holes that meet at vertices are told apart by shortest loops.
///
/// Where the border of a patch is subdivided and its neighbor's is not, patches are connected by
/// single vertices only:
///
///     ──┬───────┬───────┬──   coarse patch
///        ╲_._╱   ╲_._╱        cracks, each a hole of three sides
///     ──┴───┴───┴───┴───┴──   fine patch
///
/// From a vertex where cracks meet, the path along a patch's own border leads around the whole
/// patch, whereas the path that crosses to the other patch leads around one crack. The cracks are
/// the holes.
Holes holes_of(const TriangleMesh& mesh);

/// Longest edge of the box around a rim [m].
double rim_extent(const TriangleMesh& mesh, const HoleRim& rim);

/// Signed volume of the surface with every hole closed by a cone to the middle of its rim [m³]: a
/// measure of an open surface that does not depend on where it stands. Rounded.
double coned_volume(const TriangleMesh& mesh);

}  // namespace graspfit::geometry::internal
