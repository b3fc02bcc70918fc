#pragma once

#include <span>
#include <vector>

#include "decomposition/piece_hull.hpp"
#include "graspfit/geometry/mesh_query.hpp"

namespace graspfit::geometry::internal {

/// How far `outward_deviation` looks.
struct OutwardOptions {
  double tolerance = 0.0;  ///< Of the bound [m], > 0.
  double floor = 0.0;      ///< What is less does not matter: the answer is at least this [m].
};

/// A proven upper bound of how far any of the pieces reaches out of the solid, at most `tolerance`
/// or 5 % above the truth or the floor [m].
///
/// Cubes are cut into eight, the one that may reach farthest first: no point of a cube is farther
/// out than its center by more than half its diagonal.
double outward_deviation(std::span<const PieceHull> pieces, const MeshQuery& solid,
                         const OutwardOptions& options);

/// Volume of the union of pieces minus that of the solid [m³], along `num_lines`² parallel lines:
/// approximate, exact along each line, so that places where both agree add nothing.
double volume_difference(const std::vector<PieceHull>& pieces, const MeshQuery& solid,
                         int num_lines);

}  // namespace graspfit::geometry::internal
