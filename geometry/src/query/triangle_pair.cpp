#include "query/triangle_pair.hpp"

#include <Eigen/Geometry>

namespace graspfit::geometry::internal {

using Eigen::Vector3d;

namespace {

/// A vector at right angles to a triangle, up to some u = 2^-53 of its edges at its corners. A
/// cross product of two edges is not, where the triangle is a sliver with a height of h on its
/// longest edge L: it leans by u L / h. Of that edge and the height on it, it leans across the edge
/// only.
Vector3d normal_of(const Corners& triangle) {
  const Vector3d ab = triangle[1] - triangle[0];
  const Vector3d ac = triangle[2] - triangle[0];
  const Vector3d normal = ab.cross(ac);
  const double squared_edge = std::max(ab.squaredNorm(), ac.squaredNorm());
  if (normal.squaredNorm() > 1e-4 * squared_edge * squared_edge) return normal;
  const std::array<Vector3d, 3> edges = {ab, triangle[2] - triangle[1], -ac};
  const auto longest = std::max_element(
      edges.begin(), edges.end(),
      [](const Vector3d& e, const Vector3d& f) { return e.squaredNorm() < f.squaredNorm(); });
  // From the end of the longest edge on to the corner opposite to it.
  const Vector3d& next = edges[(longest - edges.begin() + 1) % 3];
  return longest->cross(next - next.dot(*longest) / longest->squaredNorm() * *longest);
}

double largest_coordinate(const Corners& c) {
  return c[0].cwiseAbs().cwiseMax(c[1].cwiseAbs()).cwiseMax(c[2].cwiseAbs()).maxCoeff();
}

}  // namespace

std::pair<Vector3d, Vector3d> closest_on_segments(const Vector3d& p0, const Vector3d& p1,
                                                  const Vector3d& q0, const Vector3d& q1) {
  const Vector3d u = p1 - p0;
  const Vector3d v = q1 - q0;
  const Vector3d w = p0 - q0;
  const double a = u.squaredNorm();
  const double b = u.dot(v);
  const double c = v.squaredNorm();
  const double d = u.dot(w);
  const double e = v.dot(w);
  double numerator = b * e - c * d;
  double denominator = a * c - b * b;
  if (!(denominator > 1e-2 * (a * c))) {
    const Vector3d normal = u.cross(v);
    numerator = normal.dot(v.cross(w));
    denominator = normal.squaredNorm();
  }
  double s = denominator > 0.0 ? std::clamp(numerator / denominator, 0.0, 1.0) : 0.0;
  double t = c > 0.0 ? (b * s + e) / c : 0.0;
  if (t < 0.0 || t > 1.0) {
    t = std::clamp(t, 0.0, 1.0);
    s = a > 0.0 ? std::clamp((b * t - d) / a, 0.0, 1.0) : 0.0;
  }
  return {p0 + s * u, q0 + t * v};
}

std::optional<Vector3d> piercing(const Corners& a, const Corners& b) {
  const Vector3d normal = normal_of(b);
  const std::array<double, 3> side = {normal.dot(a[0] - b[0]), normal.dot(a[1] - b[0]),
                                      normal.dot(a[2] - b[0])};
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (!(side[i] * side[j] < 0.0)) continue;
    const Vector3d point = a[i] + side[i] / (side[i] - side[j]) * (a[j] - a[i]);
    bool is_inside = true;
    for (int k = 0; k < 3 && is_inside; ++k) {
      const Vector3d& from = b[k];
      is_inside = (b[(k + 1) % 3] - from).cross(point - from).dot(normal) >= 0.0;
    }
    if (!is_inside) continue;
    // Beyond the tip of a needle rounding hides on which side of its edges a point is.
    const double rounding = 1e-13 * std::max(largest_coordinate(a), largest_coordinate(b));
    if ((closest_on_triangle(point, b) - point).norm() <= rounding) return point;
  }
  return std::nullopt;
}

}  // namespace graspfit::geometry::internal
