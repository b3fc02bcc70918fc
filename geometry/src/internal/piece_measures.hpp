#pragma once

#include <vector>

#include "graspfit/geometry/mesh_query.hpp"
#include "internal/piece_hull.hpp"

namespace graspfit::geometry::internal {

/// A proven upper bound of how far any of the pieces reaches out of the solid, at most `tolerance`
/// above the truth, unless the truth is below `tolerance` [m].
///
/// Boxes are quartered (in space: into eight) as long as what is in them might reach farther than
/// what is known, by the distance of their center from the surface, which changes no faster than
/// the center moves.
double outward_deviation(const std::vector<PieceHull>& pieces, const MeshQuery& solid,
                         double tolerance);

/// Volume of the union of pieces minus that of the solid [m³], along `num_lines`² parallel lines:
/// approximate, exact along each line, so that places where both agree add nothing.
double volume_difference(const std::vector<PieceHull>& pieces, const MeshQuery& solid,
                         int num_lines);

}  // namespace graspfit::geometry::internal
