#include "scene/distance_up_to.hpp"

#include <Eigen/Geometry>
#include <limits>

#include "graspfit/geometry/surface_proximity.hpp"

namespace graspfit::grasp::internal {

using Eigen::Vector3d;
using geometry::RigidTransform;

namespace {

/// Lower bound of the distance of two boxes, from the axes of the first.
double box_gap(const Eigen::AlignedBox3d& box_A, const Eigen::AlignedBox3d& box_B,
               const RigidTransform& X_AB) {
  const Vector3d center_A = X_AB * box_B.center();
  const Vector3d half_A = X_AB.linear().cwiseAbs() * (0.5 * box_B.sizes());
  const Eigen::AlignedBox3d seen_A(center_A - half_A, center_A + half_A);
  return box_A.exteriorDistance(seen_A) - kBoxSlack;
}

}  // namespace

geometry::MeshDistance distance_up_to(const geometry::MeshQuery& a, const geometry::MeshQuery& b,
                                      const RigidTransform& X_AB, double enough) {
  const geometry::MeshDistance none{std::numeric_limits<double>::infinity(), Vector3d::Zero(),
                                    Vector3d::Zero()};
  if (box_gap(a.box(), b.box(), X_AB) > enough) return none;
  if (geometry::is_rotation(X_AB) && box_gap(b.box(), a.box(), X_AB.inverse()) > enough) {
    return none;
  }
  if (geometry::do_intersect(a, b, X_AB)) return {0.0, Vector3d::Zero(), Vector3d::Zero()};
  const auto found = geometry::nearest_points(a, b, X_AB, enough);
  if (!found) return none;
  return {found->distance, found->point_on_a_A, found->point_on_b_A};
}

}  // namespace graspfit::grasp::internal
