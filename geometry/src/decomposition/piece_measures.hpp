#pragma once

#include <span>
#include <vector>

#include "decomposition/piece_hull.hpp"
#include "graspfit/geometry/mesh_query.hpp"

namespace graspfit::geometry::internal {

/// How precise `outward_deviation` is.
struct OutwardOptions {
  double tolerance = 0.0;  ///< Of the bound [m], > 0.
  double floor = 0.0;  ///< Deviations below this do not matter: the result is at least this [m].
};

/// A proven upper bound of how far any of the pieces reaches out of the solid, at most `tolerance`
/// or 5 % above the truth or the floor [m].
///
/// Branch and bound: cubes are cut into eight, first the one whose points may reach farthest out.
/// No point of a cube is farther out than the cube's center by more than half the cube's diagonal.
double outward_deviation(std::span<const PieceHull> pieces, const MeshQuery& solid,
                         const OutwardOptions& options);

/// Volume of the union of pieces minus that of the solid [m³], along `num_lines`² parallel lines:
/// approximate, exact along each line, so that places where both agree add nothing.
double volume_difference(const std::vector<PieceHull>& pieces, const MeshQuery& solid,
                         int num_lines);

}  // namespace graspfit::geometry::internal
