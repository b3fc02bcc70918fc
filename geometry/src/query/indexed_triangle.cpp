#include "query/indexed_triangle.hpp"

#include <algorithm>

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3d;

// A triangle is a sliver where twice its area is below a hundredth of the square of an edge. Both
// are compared in squares.
constexpr double kSquaredThinness = 1e-4;

// A rounded point of a segment or a triangle, back in its box.
Vector3d in_box(const Vector3d& point, const Eigen::AlignedBox3d& box) {
  return point.cwiseMax(box.min()).cwiseMin(box.max());
}
Vector3d in_box(const Vector3d& point, const Vector3d& a, const Vector3d& b) {
  return in_box(point, {a.cwiseMin(b), a.cwiseMax(b)});
}

// Share of `b` in the point of the segment from a to b nearest to `point`.
double closest_on_segment(const Vector3d& point, const Vector3d& a, const Vector3d& b) {
  const Vector3d ab = b - a;
  const double squared = ab.squaredNorm();
  return squared > 0.0 ? std::clamp((point - a).dot(ab) / squared, 0.0, 1.0) : 0.0;
}

// The nearest point of a sliver, or of a triangle for which rounding has left no region: inside, or
// on the nearest of its edges.
//
// Edges give their points to a few u = 2^-53 of their length and of the way to them. Inside, the
// point is found in the frame of the longest edge, of length L, and of the height h on it, a vector
// that is off by some u L. At a distance H from the plane this moves the point across the edge by
// some u L (1 + H / h); since it stays in the triangle, also by no more than about h. Where H is
// large this enters the distance by its square over 2 H, so that the distance is off by some u L at
// most, however thin the triangle is.
[[gnu::cold, gnu::noinline]] TrianglePoint nearest_on_sliver(
    const Vector3d& point, const std::array<Vector3d, 3>& corners) {
  int i = 0;
  double squared_longest = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double squared = (corners[(k + 1) % 3] - corners[k]).squaredNorm();
    if (squared > squared_longest) {
      squared_longest = squared;
      i = k;
    }
  }
  const int j = (i + 1) % 3;
  const int k = (i + 2) % 3;
  const Vector3d edge = corners[j] - corners[i];
  const Vector3d to_apex = corners[k] - corners[i];
  const Vector3d to_point = point - corners[i];
  const double foot_of_apex = to_apex.dot(edge) / squared_longest;
  const double foot_of_point = to_point.dot(edge) / squared_longest;
  const Vector3d height = to_apex - foot_of_apex * edge;
  const double of_apex = (to_point - foot_of_point * edge).dot(height) / height.squaredNorm();
  const double of_end = foot_of_point - of_apex * foot_of_apex;
  // Comparisons with what is no number, as in a triangle that is a segment, are false.
  if (of_apex >= 0.0 && of_end >= 0.0 && of_apex + of_end <= 1.0) {
    TrianglePoint inside{in_box(corners[i] + of_end * edge + of_apex * to_apex, box_of(corners)),
                         Vector3d::Zero()};
    inside.barycentric[i] = 1.0 - (of_apex + of_end);
    inside.barycentric[j] = of_end;
    inside.barycentric[k] = of_apex;
    return inside;
  }
  TrianglePoint best{corners[0], {1, 0, 0}};
  for (int start = 0; start < 3; ++start) {
    const int end = (start + 1) % 3;
    const Vector3d& a = corners[start];
    const Vector3d& b = corners[end];
    const double t = closest_on_segment(point, a, b);
    TrianglePoint candidate{in_box(a + t * (b - a), a, b), Vector3d::Zero()};
    if (!((candidate.point - point).squaredNorm() < (best.point - point).squaredNorm())) continue;
    candidate.barycentric[start] = 1.0 - t;
    candidate.barycentric[end] = t;
    best = candidate;
  }
  return best;
}

}  // namespace

TrianglePoint nearest_on_triangle(const Vector3d& point, const std::array<Vector3d, 3>& corners) {
  // Regions of the triangle's plane as in [Ericson 2005, 5.1.5]: corners, edges, inside.
  const auto& [a, b, c] = corners;
  const Vector3d ab = b - a;
  const Vector3d ac = c - a;
  const Vector3d ap = point - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {a, {1, 0, 0}};
  const Vector3d bp = point - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return {b, {0, 1, 0}};
  const Vector3d cp = point - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  // Rounding hides vc, vb and va where they are below 20 u |ab| |ac| |ap| |bp| and the like. What
  // is taken to an edge for that is inside by no more than 20 u |ap| |bp| over a height: beside a
  // triangle that is no sliver by less than 2000 u (2.3e-13) of its longest edge.
  const double ab_ab = d1 - d3;
  const double ac_ac = d2 - d6;
  const double ab_ac = d2 - d4;
  const double squared_edge = std::max(ab_ab, ac_ac);
  if (!(ab_ab * ac_ac - ab_ac * ab_ac > kSquaredThinness * squared_edge * squared_edge)) {
    return nearest_on_sliver(point, corners);
  }
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 - d3 > 0.0) {
    const double t = d1 / (d1 - d3);
    return {in_box(a + t * ab, a, b), {1.0 - t, t, 0}};
  }
  if (d6 >= 0.0 && d5 <= d6) return {c, {0, 0, 1}};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 - d6 > 0.0) {
    const double t = d2 / (d2 - d6);
    return {in_box(a + t * ac, a, c), {1.0 - t, 0, t}};
  }
  const double va = d3 * d6 - d5 * d4;
  const double along = (d4 - d3) + (d5 - d6);
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 && along > 0.0) {
    const double t = (d4 - d3) / along;
    return {in_box(b + t * (c - b), b, c), {0, 1.0 - t, t}};
  }
  // In the frame of ab and the height on it, as vb and vc over their sum would be off by some
  // u (L / h)^2, not by u L / h.
  const double share = ab_ac / ab_ab;
  const double foot = d1 / ab_ab;
  const Vector3d height = ac - share * ab;
  const double w = (ap - foot * ab).dot(height) / height.squaredNorm();
  const double v = foot - w * share;
  if (v >= 0.0 && w >= 0.0 && v + w <= 1.0) {
    return {in_box(a + v * ab + w * ac, box_of(corners)), {1.0 - (v + w), v, w}};
  }
  return nearest_on_sliver(point, corners);
}

}  // namespace graspfit::geometry::internal
