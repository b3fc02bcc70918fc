#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry::internal {

/// A binary tree of axis-aligned boxes over the faces of a mesh. Boxes are exact: the least and
/// greatest coordinates of the vertices below.
struct BoxTree {
  struct Node {
    Eigen::Vector3d lower;
    Eigen::Vector3d upper;
    std::int32_t first = 0;  ///< Leaf: first of its triangles. Inner node: its second child; the
                             ///< first child follows the node itself.
    std::int32_t count = 0;  ///< Leaf: number of triangles, > 0. Inner node: 0.
  };
  struct Triangle {
    std::array<Eigen::Vector3d, 3> corners;
    std::int32_t face = -1;
  };

  std::vector<Node> nodes;  ///< The root is node 0.
  std::vector<Triangle> triangles;

  explicit BoxTree(const TriangleMesh& mesh);
};

/// Squared distance from a point to a box; zero inside.
inline double squared_distance(const Eigen::Vector3d& point, const BoxTree::Node& node) {
  return (node.lower - point).cwiseMax(point - node.upper).cwiseMax(0.0).squaredNorm();
}

/// A point of a triangle and its weights of the corners, each ≥ 0, sum 1 up to rounding.
struct TrianglePoint {
  Eigen::Vector3d point;
  Eigen::Vector3d barycentric;
};

/// The point of a closed triangle nearest to `point`. Approximate to rounding; degenerate triangles
/// count as the segments or points that they are.
TrianglePoint nearest_on_triangle(const Eigen::Vector3d& point,
                                  const std::array<Eigen::Vector3d, 3>& corners);
inline Eigen::Vector3d closest_on_triangle(const Eigen::Vector3d& point,
                                           const std::array<Eigen::Vector3d, 3>& corners) {
  return nearest_on_triangle(point, corners).point;
}

/// First triangle on a ray, and where, in units of the direction.
struct QuickHit {
  std::int32_t triangle = -1;  ///< Index into `BoxTree::triangles`; −1: none.
  double t = 0.0;
};

/// First hit of the ray from `origin` along `direction` on any face but `skipped_face`, in plain
/// doubles: for statistics over many rays, not for decisions.
///
/// Approximate: triangles are taken larger by 1e-9 of their size, so that no ray slips between two
/// of them; one seen edge-on is missed, its neighbors are not. Of equal hits the lowest face.
QuickHit quick_first_hit(const BoxTree& tree, const Eigen::Vector3d& origin,
                         const Eigen::Vector3d& direction, std::int32_t skipped_face);

}  // namespace graspfit::geometry::internal
