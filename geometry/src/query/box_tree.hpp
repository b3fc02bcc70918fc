#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "query/indexed_triangle.hpp"

namespace graspfit::geometry::internal {

/// Larger than the depth of any tree: below level 48 the builder halves the set of triangles.
inline constexpr int kMostTreeDepth = 128;

/// A binary tree of axis-aligned boxes over the faces of a mesh, for searches that walk two trees
/// at once, one of them moved; all others walk a `FaceTree`. Boxes are exact: the least and
/// greatest coordinates of the vertices below.
struct BoxTree {
  struct Node {
    Eigen::Vector3d lower;
    Eigen::Vector3d upper;
    std::int32_t first = 0;  ///< Leaf: first of its triangles. Inner node: its second child; the
                             ///< first child follows the node itself.
    std::int32_t count = 0;  ///< Leaf: number of triangles, > 0. Inner node: 0.
  };
  std::vector<Node> nodes;  ///< The root is node 0.
  std::vector<IndexedTriangle> triangles;

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

}  // namespace graspfit::geometry::internal
