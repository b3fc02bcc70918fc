#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

/// \file
/// Convex hulls in the plane and in space by CGAL's `convex_hull_2` and `convex_hull_3`, whose
/// results are brought into a form that depends on the points alone: CGAL may keep points within a
/// facet or an edge as vertices, and cuts coplanar facets and orders all of them as memory lies.

namespace graspfit::geometry::internal {

/// Which points are the corners of a convex hull in space, and of which facets. Exact.
struct ExactHull {
  int rank = -1;                     ///< Dimension of the points' affine span; −1 without points.
  std::vector<std::size_t> corners;  ///< The extreme points, ascending; at rank 2 counter-clockwise
                                     ///< from the least on in the first of the planes xy, xz, yz
                                     ///< in which they have area.
  std::vector<std::array<std::size_t, 3>> triangles;  ///< At rank 3, counter-clockwise seen from
                                                      ///< outside, the least corner first, in
                                                      ///< lexicographic order. A facet with more
                                                      ///< corners is a fan from the least point
                                                      ///< (x, y, z).
};

/// Indices of distinct points in lexicographic order; of equal points the first.
std::vector<std::size_t> distinct_points(std::span<const Eigen::Vector3d> points);

/// The hull of finite points; of equal points the first counts.
ExactHull exact_hull(std::span<const Eigen::Vector3d> points);

/// Corners of the hull of the points `chosen`, seen in the plane of the coordinates `u` and `v`:
/// counter-clockwise from the least (u, v) on; of equal points the first counts. Exact. Fewer than
/// three where the points lie on a line.
std::vector<std::size_t> hull_in_plane(std::span<const Eigen::Vector3d> points,
                                       std::span<const std::size_t> chosen, int u, int v);

}  // namespace graspfit::geometry::internal
