#include "query/winding.hpp"

#include "query/indexed_mesh.hpp"

namespace graspfit::geometry::internal {

Winding winding_around(const MeshQuery& query, const Eigen::Vector3d& point) {
  Winding winding(point);
  query.indexed().tree().traverse(
      [&](const Eigen::AlignedBox3d& box) { return winding.may_meet(box.min(), box.max()); },
      [&](const IndexedTriangle& triangle) { winding.add(triangle.corners); });
  return winding;
}

}  // namespace graspfit::geometry::internal
