#pragma once

#include <CGAL/Gmpq.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/rational_clip.hpp"

/// \file
/// The oracles of distances, in rational arithmetic and straight from the definition: points,
/// segments and triangles, all closed, degenerate ones included.

namespace graspfit::testing {

/// Returns the place on the way from `a` to `b`, at 0 for `a` and 1 for `b`.
inline RationalPoint between(const RationalPoint& a, const RationalPoint& b, const Rational& at) {
  return {a[0] + at * (b[0] - a[0]), a[1] + at * (b[1] - a[1]), a[2] + at * (b[2] - a[2])};
}

inline Rational squared_length(const RationalPoint& v) { return dot(v, v); }

/// Returns the squared distance of a point from the segment from `a` to `b`.
inline Rational squared_distance_to_segment(const RationalPoint& point, const RationalPoint& a,
                                            const RationalPoint& b) {
  const RationalPoint along = minus(b, a);
  const Rational squared = squared_length(along);
  Rational at = 0;
  if (squared != 0) at = dot(minus(point, a), along) / squared;
  if (at < 0) at = 0;
  if (at > 1) at = 1;
  return squared_length(minus(point, between(a, b, at)));
}

/// Returns the squared distance of a point from a triangle.
inline Rational squared_distance_to_triangle(const RationalPoint& point,
                                             const std::array<RationalPoint, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  Rational least =
      std::min({squared_distance_to_segment(point, a, b), squared_distance_to_segment(point, b, c),
                squared_distance_to_segment(point, c, a)});
  const RationalPoint normal = cross(minus(b, a), minus(c, a));
  const Rational squared = squared_length(normal);
  if (squared == 0) return least;
  // The foot of the point on the triangle's plane is inside if it is left of all edges.
  for (int i = 0; i < 3; ++i) {
    const RationalPoint edge = minus(triangle[(i + 1) % 3], triangle[i]);
    if (dot(cross(edge, minus(point, triangle[i])), normal) < 0) return least;
  }
  const Rational height = dot(minus(point, a), normal);
  return std::min(least, Rational(height * height / squared));
}

/// Returns the squared distance of the segments from `a` to `b` and from `c` to `d`.
inline Rational squared_distance_of_segments(const RationalPoint& a, const RationalPoint& b,
                                             const RationalPoint& c, const RationalPoint& d) {
  const Rational least =
      std::min({squared_distance_to_segment(a, c, d), squared_distance_to_segment(b, c, d),
                squared_distance_to_segment(c, a, b), squared_distance_to_segment(d, a, b)});
  const RationalPoint u = minus(b, a);
  const RationalPoint v = minus(d, c);
  const RationalPoint normal = cross(u, v);
  const Rational squared = squared_length(normal);
  if (squared == 0) return least;
  // Where the common perpendicular of the lines meets them.
  const RationalPoint w = minus(c, a);
  const Rational at_u = dot(cross(w, v), normal) / squared;
  const Rational at_v = dot(cross(w, u), normal) / squared;
  if (at_u < 0 || at_u > 1 || at_v < 0 || at_v > 1) return least;
  const Rational gap = dot(w, normal);
  return std::min(least, Rational(gap * gap / squared));
}

/// Returns whether the segment from `a` to `b` passes from one side of a triangle's plane to the
/// other within the triangle.
inline bool passes_through(const RationalPoint& a, const RationalPoint& b,
                           const std::array<RationalPoint, 3>& triangle) {
  const RationalPoint normal =
      cross(minus(triangle[1], triangle[0]), minus(triangle[2], triangle[0]));
  const Rational from = dot(minus(a, triangle[0]), normal);
  const Rational to = dot(minus(b, triangle[0]), normal);
  if (!((from < 0 && to > 0) || (from > 0 && to < 0))) return false;
  return squared_distance_to_triangle(between(a, b, from / (from - to)), triangle) == 0;
}

/// Returns the squared distance of two triangles: zero if they cross, or else between a corner and
/// a triangle or between two edges.
inline Rational squared_distance_of_triangles(const std::array<RationalPoint, 3>& a,
                                              const std::array<RationalPoint, 3>& b) {
  Rational least = squared_distance_to_triangle(a[0], b);
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    if (passes_through(a[i], a[next], b) || passes_through(b[i], b[next], a)) return 0;
    least = std::min(
        {least, squared_distance_to_triangle(a[i], b), squared_distance_to_triangle(b[i], a)});
    for (int j = 0; j < 3; ++j) {
      least = std::min(least, squared_distance_of_segments(a[i], a[next], b[j], b[(j + 1) % 3]));
    }
  }
  return least;
}

inline std::array<RationalPoint, 3> exactly(const Triangle& triangle) {
  return {exactly(triangle[0]), exactly(triangle[1]), exactly(triangle[2])};
}

/// Returns the root of an exact number that is not negative, off by an ulp or two.
inline double rounded_root(const Rational& squared) { return std::sqrt(CGAL::to_double(squared)); }

}  // namespace graspfit::testing
