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

/// The point of a closed triangle nearest to `point`. Approximate to rounding; degenerate triangles
/// count as the segments or points that they are.
Eigen::Vector3d closest_on_triangle(const Eigen::Vector3d& point,
                                    const std::array<Eigen::Vector3d, 3>& corners);

}  // namespace graspfit::geometry::internal
