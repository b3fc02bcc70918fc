#pragma once

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::testing {

/// Returns the seconds that CGAL takes to build its AABB tree, with the search tree for distances,
/// over the faces of a mesh in ordinary doubles (Simple_cartesian): the unit in which planning is
/// timed.
double seconds_of_cgal_tree(const geometry::TriangleMesh& mesh);

}  // namespace graspfit::testing
