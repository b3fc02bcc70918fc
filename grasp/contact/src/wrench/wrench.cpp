#include "graspfit/contact/wrench.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <utility>

#include "contacts/contact_check.hpp"
#include "graspfit/base/option_check.hpp"

namespace graspfit::contact {
namespace {

using Eigen::Vector3d;

/// Returns cosine and sine of 2 π i / n, computed in the first octant so that they have the
/// symmetries of the octants exactly.
std::pair<double, double> turn(int i, int n) {
  const int octant = 8 * i / n;
  const int rest = 8 * i % n;
  const bool is_falling = octant % 2 != 0;
  const double angle = 0.25 * std::numbers::pi * (is_falling ? n - rest : rest) / n;
  const bool is_diagonal = is_falling && rest == 0;
  double c = is_diagonal ? std::numbers::sqrt2 / 2.0 : std::cos(angle);
  double s = is_diagonal ? std::numbers::sqrt2 / 2.0 : std::sin(angle);
  if (is_falling) s = -s;
  for (int quarter = 0; quarter < (octant + 1) / 2; ++quarter) c = -std::exchange(s, c);
  return {c, s};
}

}  // namespace

FrictionCone friction_cone(const Vector3d& inward_normal_O, double friction) {
  internal::require_unit("friction_cone", inward_normal_O);
  base::require(friction >= 0.0 && std::isfinite(friction), "friction_cone", "friction", friction,
                "finite and at least 0");
  const Vector3d axis = std::abs(inward_normal_O.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY();
  FrictionCone cone;
  cone.inward_normal_O = inward_normal_O;
  cone.tangent_1_O = inward_normal_O.cross(axis).normalized();
  cone.tangent_2_O = inward_normal_O.cross(cone.tangent_1_O);
  cone.friction = friction;
  return cone;
}

Eigen::Matrix3Xd cone_edges(const FrictionCone& cone, int num_edges) {
  base::require(num_edges >= 3, "cone_edges", "num_edges", num_edges, "at least 3");
  Eigen::Matrix3Xd edges(3, num_edges);
  for (int i = 0; i < num_edges; ++i) {
    const auto [c, s] = turn(i, num_edges);
    edges.col(i) =
        cone.inward_normal_O + cone.friction * (c * cone.tangent_1_O + s * cone.tangent_2_O);
  }
  return edges;
}

Wrench wrench(const Vector3d& force_O, const Vector3d& point_O, const Vector3d& reference_point_O,
              double torque_scale) {
  Wrench result;
  result << force_O, (point_O - reference_point_O).cross(force_O) / torque_scale;
  return result;
}

Wrenches grasp_matrix(std::span<const Contact> contacts, const Vector3d& reference_point_O,
                      double torque_scale) {
  base::require(torque_scale > 0.0 && std::isfinite(torque_scale), "grasp_matrix", "torque_scale",
                torque_scale, "finite and positive");
  internal::require_finite("grasp_matrix", contacts, reference_point_O);
  Wrenches matrix(6, 3 * contacts.size());
  Eigen::Index column = 0;
  for (const Contact& contact : contacts) {
    const FrictionCone cone = friction_cone(contact.inward_normal_O, 0.0);
    for (const Vector3d& axis : {cone.tangent_1_O, cone.tangent_2_O, cone.inward_normal_O}) {
      matrix.col(column++) = wrench(axis, contact.point_O, reference_point_O, torque_scale);
    }
  }
  return matrix;
}

}  // namespace graspfit::contact
