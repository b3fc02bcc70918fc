#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

namespace graspfit::geometry::internal {

/// Of a triangle.
using Corners = std::array<Eigen::Vector3d, 3>;

/// A face of a mesh with copies of its corners.
struct IndexedTriangle {
  Corners corners;
  std::int32_t face = -1;
};

/// Box of a triangle. Exact.
inline Eigen::AlignedBox3d box_of(const Corners& corners) {
  const auto& [a, b, c] = corners;
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

/// A triangle cut at the middles of its edges.
inline std::array<Corners, 4> quarters_of(const Corners& corners) {
  const auto& [a, b, c] = corners;
  const Eigen::Vector3d ab = 0.5 * (a + b);
  const Eigen::Vector3d bc = 0.5 * (b + c);
  const Eigen::Vector3d ca = 0.5 * (c + a);
  return {{{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}};
}

/// A point of a triangle and its weights of the corners, each ≥ 0, sum 1 up to rounding.
struct TrianglePoint {
  Eigen::Vector3d point;
  Eigen::Vector3d barycentric;
};

/// The point of a closed triangle nearest to `point`, in the triangle up to rounding and in its box
/// exactly. Its distance
/// is at most 2.3e-13 of the longest edge too large, and within 1e-15 of it for slivers, beside the
/// rounding of coordinates and of the distance; degenerate triangles count as the segments or
/// points that they are.
TrianglePoint nearest_on_triangle(const Eigen::Vector3d& point,
                                  const std::array<Eigen::Vector3d, 3>& corners);
inline Eigen::Vector3d closest_on_triangle(const Eigen::Vector3d& point,
                                           const std::array<Eigen::Vector3d, 3>& corners) {
  return nearest_on_triangle(point, corners).point;
}

}  // namespace graspfit::geometry::internal
