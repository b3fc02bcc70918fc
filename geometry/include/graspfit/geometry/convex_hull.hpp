#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace graspfit::geometry {

/// A facet of a hull: corner indices into the input points, counter-clockwise from outside.
using HullFacet = std::vector<std::size_t>;

/// The convex hull of points in space, of whatever dimension the points span.
struct ConvexHull3 {
  int rank = -1;  ///< Dimension spanned: −1 no points, 0 one, 1 line, 2 plane, 3 space.
  std::vector<std::size_t> vertices;  ///< Extreme points, ascending. rank 2: in order around.
  std::vector<HullFacet> facets;      ///< rank 3: triangles; coplanar ones not merged. rank 2: the
                                      ///< polygon once. Otherwise empty.
  double measure = 0.0;               ///< Length, area or volume by rank [m, m², m³]. Rounded.
  Eigen::Vector3d centroid =
      Eigen::Vector3d::Zero();  ///< Of that measure [m]; of one point itself. Where a flattened
                                ///< hull has no measure left, the mean of its vertices.
};

/// Thresholds below which a spread counts as none. Zero asks for the exact rank.
struct HullOptions {
  double collinear_rel = 0.0;  ///< Second over first singular value of the centered points, ≥ 0.
  double planar_rel = 0.0;     ///< Thickness over extent (range along the third / first principal
                            ///< axis), ≥ 0. Planar points are projected to their best-fit plane
                            ///< before the polygon is taken and measured.
};

/// Hull, its measure and centroid: `ConvexPolytope` in space, with thresholds that let nearly flat
/// and nearly collinear sets count as such. With zero thresholds the combinatorics are exact;
/// measure and centroid are rounded. Equal points: the first counts.
/// @throws InvalidInput for a point that is not finite and a threshold that is not at least 0.
ConvexHull3 convex_hull(std::span<const Eigen::Vector3d> points, const HullOptions& options = {});

}  // namespace graspfit::geometry
