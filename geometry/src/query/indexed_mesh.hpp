#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "query/box_tree.hpp"

namespace graspfit::geometry::internal {

/// What a `MeshQuery` holds, which its copies share.
struct IndexedMesh {
  /// @throws InvalidInput if the mesh has no faces.
  explicit IndexedMesh(TriangleMesh the_mesh);

  TriangleMesh mesh;
  BoxTree tree;
  Eigen::AlignedBox3d box;                  ///< Of the faces; unused vertices do not count.
  std::vector<std::int32_t> part_vertices;  ///< One vertex of each set of faces that are connected
                                            ///< by common vertices, ascending.
};

}  // namespace graspfit::geometry::internal
