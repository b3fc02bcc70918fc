#include "mesh/input_check.hpp"

#include <string>
#include <utility>

#include "graspfit/base/errors.hpp"

namespace graspfit::geometry::internal {

void require_usable(const TriangleMesh& mesh, const char* who) {
  for (std::size_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
    if (mesh.vertices[vertex].allFinite()) continue;
    throw base::InvalidInput(std::string(who) + ": vertex " + std::to_string(vertex) +
                             " is not finite");
  }
  require_indices(mesh, who);
}

void require_indices(const TriangleMesh& mesh, const char* who) {
  const std::size_t count = mesh.vertices.size();
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    for (const std::int32_t vertex : mesh.faces[face]) {
      if (vertex >= 0 && std::cmp_less(vertex, count)) continue;
      throw base::InvalidInput(std::string(who) + ": face " + std::to_string(face) +
                               " has vertex " + std::to_string(vertex) + " of " +
                               std::to_string(count));
    }
  }
}

void require_finite(const RigidTransform& pose, const char* who) {
  if (pose.matrix().allFinite()) return;
  throw base::InvalidInput(std::string(who) + ": the pose is not finite");
}

}  // namespace graspfit::geometry::internal
