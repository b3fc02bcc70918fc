#include "query/indexed_triangle.hpp"

#include <algorithm>

namespace graspfit::geometry::internal {
namespace {

// Share of `b` in the point of the segment from a to b nearest to `point`.
double closest_on_segment(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                          const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double squared = ab.squaredNorm();
  return squared > 0.0 ? std::clamp((point - a).dot(ab) / squared, 0.0, 1.0) : 0.0;
}

}  // namespace

TrianglePoint nearest_on_triangle(const Eigen::Vector3d& point,
                                  const std::array<Eigen::Vector3d, 3>& corners) {
  // Regions of the triangle's plane as in [Ericson 2005, 5.1.5]: corners, edges, inside.
  const auto& [a, b, c] = corners;
  const Eigen::Vector3d ab = b - a;
  const Eigen::Vector3d ac = c - a;
  const Eigen::Vector3d ap = point - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {a, {1, 0, 0}};
  const Eigen::Vector3d bp = point - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return {b, {0, 1, 0}};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 - d3 > 0.0) {
    const double t = d1 / (d1 - d3);
    return {a + t * ab, {1.0 - t, t, 0}};
  }
  const Eigen::Vector3d cp = point - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return {c, {0, 0, 1}};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 - d6 > 0.0) {
    const double t = d2 / (d2 - d6);
    return {a + t * ac, {1.0 - t, 0, t}};
  }
  const double va = d3 * d6 - d5 * d4;
  const double along = (d4 - d3) + (d5 - d6);
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 && along > 0.0) {
    const double t = (d4 - d3) / along;
    return {b + t * (c - b), {0, 1.0 - t, t}};
  }
  const double sum = va + vb + vc;
  if (sum > 0.0 && va >= 0.0 && vb >= 0.0 && vc >= 0.0) {
    const double v = vb / sum;
    const double w = vc / sum;
    return {a + v * ab + w * ac, {std::max(0.0, 1.0 - v - w), v, w}};
  }
  // In a sliver rounding prevails: the nearest point of its edges is then as near as any inside.
  TrianglePoint best{a, {1, 0, 0}};
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const double t = closest_on_segment(point, corners[i], corners[j]);
    TrianglePoint candidate{corners[i] + t * (corners[j] - corners[i]), Eigen::Vector3d::Zero()};
    candidate.barycentric[i] = 1.0 - t;
    candidate.barycentric[j] = t;
    if ((candidate.point - point).squaredNorm() < (best.point - point).squaredNorm()) {
      best = candidate;
    }
  }
  return best;
}

}  // namespace graspfit::geometry::internal
