#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "graspfit/base/content_cache.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// How finely a solid is cut into convex pieces.
struct ConvexDecompositionOptions {
  double largest_deviation =
      0.001;            ///< Wanted: no piece reaches farther out of the solid [m], > 0 and finite.
  int max_pieces = 64;  ///< ≥ 1; where it does not suffice, the worst places come first.
  int max_piece_vertices = 128;  ///< ≥ 32. Pieces of round solids lie inside them by as much as
                                 ///< their corners are apart; counted in inward_deviation.
  void validate() const;         ///< Throws InvalidInput naming the field and its value.
};

/// Convex pieces in place of a solid, for engines that know convex shapes only.
struct ConvexDecomposition {
  std::vector<TriangleMesh> pieces;  ///< Closed, outward, convex, none thinner than 1e-5 of the
                                     ///< solid's longest extent; in the mesh's frame [m].
  double outward_deviation = 0.0;    ///< No piece reaches farther out of the solid [m]: a bound
                                     ///< proven up to rounding, above the truth by at most 5 % of
                                     ///< it or of largest_deviation, but never below half of the
                                     ///< latter, or 0 where the pieces together have the solid's
                                     ///< volume.
  double inward_deviation = 0.0;     ///< No point of the surface is farther from the nearest piece
                                     ///< [m]: a bound, see below.
  double volume_error = 0.0;  ///< (Volume of the union of pieces − the solid's) / the solid's, by
                              ///< 128 × 128 parallel lines, exact along each: approximate.
  bool is_within_deviation = false;  ///< outward_deviation ≤ the wanted one.
  bool operator==(const ConvexDecomposition&) const = default;
};

/// Cuts the solid inside a closed mesh (see `MeshQuery::containment`) into convex pieces.
///
/// The part of the solid in a convex cell is replaced by its convex hull. The deepest hull is cut
/// by the plane that separates most of what makes it deep: segments between points of its surface
/// and faces of the hull, weighted by the square of how far outside they pass; planes of about
/// forty directions and those of the mesh's faces. Parts are cut at the true surface, so hulls
/// cover the solid and never leave the hull of what they cover. Cutting goes on to three times
/// as many parts as pieces are allowed; then those whose common hull is the least deep are united,
/// as long as it is shallow enough or there are too many. Related: [Wei et al. 2022] (CoACD)
/// measures and cuts so too, but searches planes along axes by trees.
///
/// The inward deviation is that of the hulls' corners left out: farther than 0.05
/// largest_deviation only where max_piece_vertices is reached. What a part thinner than 1e-5 of the
/// solid's longest extent covers is left out without being counted.
///
/// Deterministic. Cost: seconds for 64 pieces, more of them for 256; a bound of outward_deviation
/// costs about a third of it. Keep the result (`cached_convex_decomposition`).
/// @throws InvalidInput for bad options; DegenerateGeometry for a mesh that bounds no solid: not
/// closed, or without volume.
ConvexDecomposition convex_decomposition(const TriangleMesh& mesh,
                                         const ConvexDecompositionOptions& options = {});

/// The kind of entry that `cached_convex_decomposition` keeps.
inline constexpr std::string_view kConvexDecompositionKind = "convex_decompositions";

/// SHA-256 of all that the result depends on: vertices, faces, options and the version of the
/// algorithm.
std::string convex_decomposition_key(const TriangleMesh& mesh,
                                     const ConvexDecompositionOptions& options);

/// As `convex_decomposition`, but a result found before is read from the cache, and a new one kept
/// there (see `ContentCache`).
ConvexDecomposition cached_convex_decomposition(const TriangleMesh& mesh,
                                                const ConvexDecompositionOptions& options = {},
                                                const base::ContentCache& cache = {});

}  // namespace graspfit::geometry
