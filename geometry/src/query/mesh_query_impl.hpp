#pragma once

#include <utility>
#include <vector>

#include "graspfit/geometry/mesh_query.hpp"
#include "query/box_tree.hpp"

namespace graspfit::geometry {

struct MeshQuery::Impl {
  explicit Impl(TriangleMesh the_mesh);

  TriangleMesh mesh;
  internal::BoxTree tree;
  Eigen::AlignedBox3d box;                  ///< Of the faces; unused vertices do not count.
  std::vector<std::int32_t> part_vertices;  ///< One vertex of each set of faces that hang together
                                            ///< by common vertices, ascending.
};

}  // namespace graspfit::geometry
