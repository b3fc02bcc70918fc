#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "graspfit/base/floating_point.hpp"

namespace graspfit::geometry {

/// A facet of a hull: corner indices into the input points, counter-clockwise from outside.
using HullFacet = std::vector<std::size_t>;

/// The convex hull of points in space, of whatever dimension the points span.
struct ConvexHull3 {
  int rank = -1;  ///< Dimension of the points' affine span: −1 no points, 0 a point, 1 a line, 2 a
                  ///< plane, 3 space.
  std::vector<std::size_t> vertices;  ///< Indices of the extreme points, ascending; at rank 2 in
                                      ///< order around the polygon.
  std::vector<HullFacet> facets;  ///< At rank 3 triangles, coplanar ones not merged; at rank 2 the
                                  ///< polygon once; otherwise empty.
  double measure = 0.0;           ///< Length, area or volume by rank [m, m², m³]. Rounded.
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< Centroid of the hull [m], rounded. Where
                                                       ///< the hull is a point, that point; where a
                                                       ///< flattened hull has measure 0, the mean
                                                       ///< of its vertices.
};

/// Thresholds below which points count as collinear or planar. Zero asks for the exact rank.
struct HullOptions {
  double collinear_rel = 0.0;  ///< Points are collinear below this ratio of the second to the first
                               ///< singular value of the centered points, ≥ 0.
  double planar_rel = 0.0;     ///< Points are planar below this ratio of thickness to extent (range
                               ///< along the third / first principal axis), ≥ 0. They are then
                               ///< projected to their best-fit plane before the polygon is taken
                               ///< and measured.
};

/// The convex hull of points with its measure and centroid, by CGAL's `convex_hull_2` and
/// `convex_hull_3`, but nearly planar and nearly collinear points count as planar and collinear
/// below the thresholds. With zero thresholds the combinatorics are exact and depend on the points
/// alone; measure and centroid are rounded. Of equal points the first counts.
/// @throws InvalidInput for a point that is not finite and a threshold that is not at least 0.
ConvexHull3 convex_hull(std::span<const Eigen::Vector3d> points, const HullOptions& options = {});

}  // namespace graspfit::geometry
