#include "graspfit/grasp/surroundings.hpp"

#include <limits>
#include <utility>

#include "graspfit/geometry/convex_hull.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"

namespace graspfit::grasp {

using Eigen::Vector3d;
using hands::RigidTransform;

SurroundingsCollision::SurroundingsCollision(const hands::HandModel& hand,
                                             Surroundings surroundings)
    : surroundings_(std::move(surroundings)) {
  for (const hands::Link& link : hand.links) corners_L_.push_back(link.mesh_L.vertices);
}

bool SurroundingsCollision::touches(const hands::HandCollision& collision, int link,
                                    const RigidTransform& X_OL) const {
  if (surroundings_.table_z_O) {
    for (const Vector3d& corner : corners_L_[link]) {
      if ((X_OL * corner).z() <= *surroundings_.table_z_O) return true;
    }
  }
  for (const geometry::MeshQuery& obstacle : surroundings_.obstacles) {
    if (collision.link_intersects(obstacle, link, X_OL)) return true;
  }
  return false;
}

SurroundingsDistance SurroundingsCollision::distance(const hands::HandCollision& collision,
                                                     int link, const RigidTransform& X_OL,
                                                     double enough) const {
  SurroundingsDistance nearest{std::numeric_limits<double>::infinity(), Vector3d::Zero(),
                               Vector3d::UnitZ()};
  if (surroundings_.table_z_O) {
    for (const Vector3d& corner : corners_L_[link]) {
      const Vector3d point = X_OL * corner;
      const double height = point.z() - *surroundings_.table_z_O;
      if (height < nearest.distance) nearest = {height, point, Vector3d::UnitZ()};
    }
  }
  const auto& solid = collision.link_solid(link);
  if (!solid) return nearest;
  (void)enough;
  for (const geometry::MeshQuery& obstacle : surroundings_.obstacles) {
    const geometry::MeshDistance found = geometry::distance(obstacle, *solid, X_OL);
    if (found.distance >= nearest.distance) continue;
    const Vector3d way = found.point_on_b_A - found.point_on_a_A;
    nearest = {found.distance, found.point_on_b_A,
               found.distance > 0.0 ? Vector3d(way / found.distance) : Vector3d::UnitZ()};
  }
  return nearest;
}

}  // namespace graspfit::grasp
