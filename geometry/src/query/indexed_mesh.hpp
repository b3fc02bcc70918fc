#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "query/box_tree.hpp"
#include "query/face_tree.hpp"

namespace graspfit::geometry::internal {

/// What a `MeshQuery` holds, which its copies share.
class IndexedMesh {
 public:
  /// @throws InvalidInput if the mesh has no faces, or numbers that are not finite.
  explicit IndexedMesh(TriangleMesh the_mesh);

  const TriangleMesh mesh;
  const Eigen::AlignedBox3d box;                  ///< Of the faces; unused vertices do not count.
  const std::vector<std::int32_t> part_vertices;  ///< One vertex of each set of faces that are
                                                  ///< connected by common vertices, ascending.

  /// The tree for searches in this mesh, built at the first call.
  const FaceTree& tree() const {
    std::call_once(tree_once_, [this] { tree_.emplace(mesh); });
    return *tree_;
  }

  /// The tree for searches in two meshes at once, built at the first call.
  const BoxTree& pair_tree() const {
    std::call_once(pair_tree_once_, [this] { pair_tree_.emplace(mesh); });
    return *pair_tree_;
  }

 private:
  mutable std::once_flag tree_once_;
  mutable std::optional<FaceTree> tree_;
  mutable std::once_flag pair_tree_once_;
  mutable std::optional<BoxTree> pair_tree_;
};

}  // namespace graspfit::geometry::internal
