#include "query/face_tree.hpp"

namespace graspfit::geometry::internal {

FaceTree::FaceTree(const TriangleMesh& mesh) {
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    tree_.insert(FacePrimitive({corners(mesh, face), static_cast<std::int32_t>(face)}));
  }
  // At once, not at the first query, which may come from several threads.
  tree_.build();
}

}  // namespace graspfit::geometry::internal
