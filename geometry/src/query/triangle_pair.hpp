#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "query/indexed_triangle.hpp"

namespace graspfit::geometry::internal {

/// Nearest points of two segments [Ericson 2005, 5.1.9].
///
/// Between lines at an angle φ the place on the first is off by some u = 2^-53 of the lengths over
/// φ², as two differences of products cancel, but over φ only if they are had from cross products;
/// the distance is off by φ times that. So up to an angle of 0.1 cross products are taken, and the
/// distance is off by less than 400 u (5e-14) of the segments and of the way between them.
std::pair<Eigen::Vector3d, Eigen::Vector3d> closest_on_segments(const Eigen::Vector3d& p0,
                                                                const Eigen::Vector3d& p1,
                                                                const Eigen::Vector3d& q0,
                                                                const Eigen::Vector3d& q1);

/// The point where an edge of `a` passes through `b`, if one does, in rounded numbers.
std::optional<Eigen::Vector3d> piercing(const Corners& a, const Corners& b);

/// Heights of a triangle's corners over the plane of another triangle, times the length of that
/// plane's normal.
///
/// With A and B the largest coordinates of the two edges whose cross product is the normal, and D
/// the sum of those of a corner's way from their common end: each coordinate of the normal is off
/// by 8 u A B, a height by 16 u A B D. A bound that is less than D, times the length of the normal,
/// is off by 23 u A B D at most. All heights are lowered by `noise`, 64 u A B D, so that what is
/// farther than a bound surely is.
struct Heights {
  Heights(const Corners& plane, const Corners& points) {
    const Eigen::Vector3d ab = plane[1] - plane[0];
    const Eigen::Vector3d ac = plane[2] - plane[0];
    const Eigen::Vector3d normal = ab.cross(ac);
    squared_normal = normal.squaredNorm();
    double farthest = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d from_plane = points[i] - plane[0];
      of[i] = normal.dot(from_plane);
      farthest = std::max(farthest, from_plane.lpNorm<1>());
    }
    noise = 0x1p-47 * ab.lpNorm<Eigen::Infinity>() * ac.lpNorm<Eigen::Infinity>() * farthest;
    const double lowest = std::min({of[0], of[1], of[2]});
    const double highest = std::max({of[0], of[1], of[2]});
    beyond = std::max({lowest - noise, -highest - noise, 0.0});
  }
  // The comparisons are such that a triangle without area, whose plane tells nothing, counts as
  // near even where there is no bound yet and 0 times infinity is not a number.
  /// Whether the whole triangle is farther from the plane than the bound.
  bool are_beyond(double squared_bound) const {
    return beyond * beyond > squared_bound * squared_normal;
  }
  bool is_corner_near(std::size_t i, double squared_bound) const {
    return is_near(std::abs(of[i]), squared_bound);
  }
  bool is_edge_near(std::size_t i, double squared_bound) const {
    const double from = of[i];
    const double to = of[(i + 1) % 3];
    if ((from < 0.0) != (to < 0.0)) return true;
    return is_near(std::min(std::abs(from), std::abs(to)), squared_bound);
  }
  bool is_near(double height, double squared_bound) const {
    const double least = height - noise;
    return !(least > 0.0 && least * least > squared_bound * squared_normal);
  }

  double squared_normal = 0.0;
  double noise = 0.0;
  std::array<double, 3> of{};
  double beyond = 0.0;  ///< Distance of the nearest point of the triangle from the plane; 0 if the
                        ///< triangle crosses the plane, or may do so.
};

}  // namespace graspfit::geometry::internal
