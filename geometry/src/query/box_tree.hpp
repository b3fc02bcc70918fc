#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "query/indexed_triangle.hpp"

namespace graspfit::geometry::internal {

/// A binary tree of axis-aligned boxes over the faces of a mesh, for searches in two meshes, one
/// of them moved; all others walk a `FaceTree`. Boxes are exact: the least and
/// greatest coordinates of the vertices below. Of a part of the surface that is nearly flat but
/// lies at an angle to the axes, the box shows little, so that each node has a slab as well.
struct BoxTree {
  struct Node {
    Eigen::Vector3d lower;
    Eigen::Vector3d upper;
    /// Unit; the mean of the triangles' normals by area, some direction if that is zero.
    Eigen::Vector3d normal;
    double low = 0.0;        ///< If flat: least n · p of the corners below, to rounding.
    double high = 0.0;       ///< If flat: greatest.
    std::int32_t first = 0;  ///< Leaf: first of its triangles. Inner node: its second child; the
                             ///< first child follows the node itself.
    std::int32_t count = 0;  ///< Leaf: number of triangles, > 0. Inner node: 0.
    bool is_flat = false;    ///< Whether the slab is much thinner than the box is along its normal.
  };
  std::vector<Node> nodes;  ///< The root is node 0.
  std::vector<IndexedTriangle> triangles;

  explicit BoxTree(const TriangleMesh& mesh);
};

}  // namespace graspfit::geometry::internal
