#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "graspfit/base/content_cache.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// How finely a solid is cut into convex pieces.
struct ConvexDecompositionOptions {
  double largest_deviation = 0.001;  ///< Wanted bound of how far any piece reaches out of the solid
                                     ///< [m], > 0 and finite.
  /// Wanted limit of the number of pieces, ≥ 1. It is kept where pieces can be united, as those of
  /// a connected solid. Pieces whose boxes are farther than largest_deviation apart are not
  /// united: of a solid of separate parts more may be left, up to three times as many. Parts whose
  /// hulls reach farthest out are cut first.
  int max_pieces = 64;
  int max_piece_vertices = 128;  ///< Most vertices of a piece, ≥ 32. Faces of the pieces of a round
                                 ///< solid lie the deeper inside it the farther apart the pieces'
                                 ///< vertices are; inward_deviation includes this.
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// Convex pieces in place of a solid, for engines that know convex shapes only.
struct ConvexDecomposition {
  std::vector<TriangleMesh> pieces;  ///< Closed, outward, convex, none thinner than 1e-5 of the
                                     ///< solid's longest extent; in the mesh's frame [m].
  double outward_deviation = 0.0;    ///< Upper bound of how far any piece reaches out of the solid
                                     ///< [m], proven up to rounding. It exceeds the true value by
                                     ///< at most 5 % of that value or of largest_deviation, but is
                                     ///< never below half of largest_deviation; it is set to 0,
                                     ///< which is not proven, where the volumes of the pieces add
                                     ///< up to the solid's to 1e-12.
  double inward_deviation = 0.0;  ///< Upper bound of the distance of any point of the surface from
                                  ///< the nearest piece [m]; see `convex_decomposition`.
  double volume_error = 0.0;  ///< (Volume of the union of pieces − volume of the solid) / volume of
                              ///< the solid. Approximate: integrated over 128 × 128 parallel lines,
                              ///< exactly along each.
  bool is_within_deviation = false;  ///< Whether outward_deviation ≤ largest_deviation.
  bool operator==(const ConvexDecomposition&) const = default;
};

/// Cuts the solid inside a closed mesh (see `MeshQuery::containment`) into convex pieces.
///
/// Space is cut into convex cells, and the part of the solid in each cell is replaced by its convex
/// hull. The depth of a hull is how far it reaches out of the solid. The part with the deepest hull
/// is cut by the plane that separates most of what makes its hull deep: segments between points of
/// the part's surface, and faces of the hull, weighted by the square of how far outside the solid
/// they pass. Candidates are planes of about forty directions and the planes of the mesh's faces.
/// Parts are cut at the true surface, to 1e-9 of its extent: hulls cover the solid, none leaves the
/// convex hull of the part that it covers. Cutting ends when no part that a cut still improves has
/// too deep a hull, or when there are three times as many parts as pieces are allowed. Then the
/// parts whose common hull is the least deep are united, as long as that hull is shallow enough or
/// there are too many parts, but only where their boxes are no farther apart than
/// largest_deviation. Related: [Wei et al. 2022] (CoACD) measures and cuts in the same way,
/// but searches axis-aligned planes by tree search.
///
/// The inward deviation is that of the vertices that the pieces leave out of the exact hulls of the
/// parts; it exceeds 0.05 largest_deviation only where max_piece_vertices is reached. Parts thinner
/// than 1e-5 of the solid's longest extent are left out, and no deviation counts what they cover.
///
/// The result is the same bytes every time, on one build and processor. It costs seconds for 64
/// pieces and more of them for 256, about a third of that for the bound of outward_deviation;
/// `cached_convex_decomposition` keeps it.
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
