#pragma once

#include <functional>

#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "support/catch.hpp"

namespace graspfit::testing {

/// Checks for a closed, outward surface in one part, free of crossings, of this genus.
inline void check_solid(const geometry::TriangleMesh& mesh, int genus) {
  const geometry::MeshAnalysis analysis =
      geometry::analyze(mesh, {.count_self_intersections = true});
  CHECK(analysis.is_closed);
  CHECK(analysis.is_manifold);
  CHECK(analysis.is_outward);
  CHECK(analysis.num_parts == 1);
  CHECK(analysis.num_unused_vertices == 0);
  CHECK(analysis.num_degenerate_faces == 0);
  CHECK(analysis.num_self_intersections == 0u);
  // Every edge has two faces, so that V − 3/2 F + F = 2 − 2 genus.
  CHECK(2 * static_cast<long>(mesh.vertices.size()) - static_cast<long>(mesh.faces.size()) ==
        4 - 4 * genus);
}

/// Returns the limit of volumes whose error falls with the square of the edge length, by
/// Richardson's extrapolation.
inline double volume_limit(const std::function<geometry::TriangleMesh(int)>& build, int segments) {
  const double coarse = geometry::signed_volume(build(segments));
  return geometry::signed_volume(build(2 * segments)) * 4 / 3 - coarse / 3;
}

}  // namespace graspfit::testing
