#include "hull/support_margin.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "graspfit/geometry/convex_hull.hpp"

namespace graspfit::geometry::internal {

using Eigen::Vector2d;
using Eigen::Vector3d;

double support_margin(const std::vector<Vector3d>& support, const Vector3d& up,
                      const Vector3d& center) {
  const Vector3d x = up.unitOrthogonal();
  const Vector3d y = up.cross(x);
  std::vector<Vector3d> seen;
  for (const Vector3d& corner : support) {
    seen.emplace_back(x.dot(corner - center), y.dot(corner - center), 0.0);
  }
  const ConvexHull3 hull = convex_hull(seen);
  if (hull.rank != 2) return 0.0;
  std::vector<Vector2d> around;
  for (const std::size_t i : hull.vertices) around.emplace_back(seen[i].x(), seen[i].y());
  double doubled_area = 0.0;
  for (std::size_t i = 0; i < around.size(); ++i) {
    const Vector2d& a = around[i];
    const Vector2d& b = around[(i + 1) % around.size()];
    doubled_area += a.x() * b.y() - a.y() * b.x();
  }
  if (doubled_area < 0.0) std::reverse(around.begin(), around.end());
  double margin = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < around.size(); ++i) {
    const Vector2d& a = around[i];
    const Vector2d edge = around[(i + 1) % around.size()] - a;
    margin = std::min(margin, (edge.y() * a.x() - edge.x() * a.y()) / edge.norm());
  }
  return margin;
}

}  // namespace graspfit::geometry::internal
