#pragma once

#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// How finely a solid is cut into convex pieces.
struct ConvexDecompositionOptions {
  double largest_deviation =
      0.001;                    ///< Wanted: no piece reaches farther out of the solid [m], > 0.
  int max_pieces = 64;          ///< ≥ 1; where it does not suffice, the worst places come first.
  int max_piece_vertices = 64;  ///< ≥ 32. Pieces of round solids lie inside them by as much as
                                ///< their corners are apart; counted in inward_deviation.
  void validate() const;        ///< Throws InvalidInput naming the field and its value.
};

/// Convex pieces in place of a solid, for engines that know convex shapes only.
struct ConvexDecomposition {
  std::vector<TriangleMesh> pieces;  ///< Closed, outward, convex; in the mesh's frame [m].
  double outward_deviation = 0.0;    ///< Farthest that a piece reaches out of the solid [m].
  double inward_deviation = 0.0;     ///< Farthest point of the surface from the nearest piece [m].
  double volume_error = 0.0;  ///< (Volume of the union of pieces − the solid's) / the solid's.
  bool is_within_deviation = false;  ///< outward_deviation ≤ the wanted one.
};

/// Cuts the solid inside a closed mesh. Deterministic.
/// @throws InvalidInput for bad options; DegenerateGeometry for a mesh that bounds no solid.
ConvexDecomposition convex_decomposition(const TriangleMesh& mesh,
                                         const ConvexDecompositionOptions& options = {});

}  // namespace graspfit::geometry
