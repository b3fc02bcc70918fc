#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry::internal {

/// Larger than the depth of any tree: below level 48 the builder halves the set of triangles.
inline constexpr int kMostTreeDepth = 128;

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

/// Calls visit(triangle) for all triangles in leaves that are reached through nodes for which
/// enter(node) holds, in the order of the tree.
template <typename Enter, typename Visit>
void traverse(const BoxTree& tree, const Enter& enter, const Visit& visit) {
  std::array<std::int32_t, kMostTreeDepth> open;
  int size = 0;
  open[size++] = 0;
  while (size > 0) {
    const std::int32_t index = open[--size];
    const BoxTree::Node& node = tree.nodes[index];
    if (!enter(node)) continue;
    if (node.count == 0) {
      open[size++] = node.first;
      open[size++] = index + 1;
    }
    for (std::int32_t i = node.first; i < node.first + node.count; ++i) visit(tree.triangles[i]);
  }
}

/// Box of a triangle. Exact.
inline Eigen::AlignedBox3d box_of(const std::array<Eigen::Vector3d, 3>& corners) {
  const auto& [a, b, c] = corners;
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

/// A triangle cut at the middles of its edges.
inline std::array<std::array<Eigen::Vector3d, 3>, 4> quarters_of(
    const std::array<Eigen::Vector3d, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Eigen::Vector3d ab = 0.5 * (a + b);
  const Eigen::Vector3d bc = 0.5 * (b + c);
  const Eigen::Vector3d ca = 0.5 * (c + a);
  return {{{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}};
}

/// Calls visit(triangle) for all triangles whose boxes meet `box`. Exact.
template <typename Visit>
void traverse_near(const BoxTree& tree, const Eigen::AlignedBox3d& box, const Visit& visit) {
  traverse(
      tree,
      [&](const BoxTree::Node& node) {
        return box.intersects(Eigen::AlignedBox3d(node.lower, node.upper));
      },
      [&](const BoxTree::Triangle& triangle) {
        if (box.intersects(box_of(triangle.corners))) visit(triangle);
      });
}

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

/// First triangle that a ray meets, and the ray parameter t there, in units of the direction.
struct QuickHit {
  std::int32_t triangle = -1;  ///< Index into `BoxTree::triangles`; −1: none.
  double t = 0.0;
};

/// First hit of the ray from `origin` along `direction` on any face but `skipped_face`, in plain
/// doubles: for statistics over many rays, not for decisions.
///
/// Approximate: triangles are taken larger by 1e-9 of their size, so that no ray slips between two
/// of them; a triangle seen edge-on is missed, but not its neighbors. Of equal hits the one with
/// the lowest face is returned.
QuickHit quick_first_hit(const BoxTree& tree, const Eigen::Vector3d& origin,
                         const Eigen::Vector3d& direction, std::int32_t skipped_face);

}  // namespace graspfit::geometry::internal
