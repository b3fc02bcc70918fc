#include "query/face_tree.hpp"

namespace graspfit::geometry::internal {

FaceTree::FaceTree(const TriangleMesh& mesh) {
  for (std::int32_t face = 0; face < std::ssize(mesh.faces); ++face) {
    tree_.insert(FacePrimitive({corners(mesh, face), face}));
  }
  // At once, not at the first query, which may come from several threads.
  tree_.build();
}

}  // namespace graspfit::geometry::internal
