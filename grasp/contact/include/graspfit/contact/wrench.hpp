#pragma once

#include <Eigen/Core>
#include <span>

#include "graspfit/contact/contact.hpp"

/// \file
/// Friction cones and wrenches of contacts. All are in the object frame O and approximate (ordinary
/// double arithmetic).

namespace graspfit::contact {

/// [force; torque about a reference point / torque scale]: both parts in newtons.
using Wrench = Eigen::Matrix<double, 6, 1>;
/// Several wrenches, one per column.
using Wrenches = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Coulomb's cone: the forces that push into the object with a tangential part of at most
/// `friction` times the normal part.
struct FrictionCone {
  Eigen::Vector3d inward_normal_O;  ///< Unit.
  Eigen::Vector3d tangent_1_O;      ///< Unit: normal × e_x; × e_y where |normal_x| ≥ 0.9.
  Eigen::Vector3d tangent_2_O;      ///< normal × tangent 1.
  double friction;                  ///< Coefficient μ.
};

/// @throws InvalidInput unless the normal is unit within 1e-6 and 0 ≤ friction < ∞.
FrictionCone friction_cone(const Eigen::Vector3d& inward_normal_O, double friction);

/// Returns the edges of the pyramid inscribed in a cone, one per column: normal + μ (cos φ tangent
/// 1 + sin φ tangent 2) at equal angles φ from 0 on. Their normal part is 1. Eight edges lose at
/// most 7.6 % of μ in some direction. @throws InvalidInput for fewer than three.
Eigen::Matrix3Xd cone_edges(const FrictionCone& cone, int num_edges);

/// Wrench of a force [N] at a point [m] about a reference point [m].
Wrench wrench(const Eigen::Vector3d& force_O, const Eigen::Vector3d& point_O,
              const Eigen::Vector3d& reference_point_O, double torque_scale);

/// Returns the 6 × 3k matrix that maps contact forces, per contact along tangent 1, tangent 2 and
/// the inward normal, to their total wrench. @throws InvalidInput as `friction_cone`, for numbers
/// that are not finite, and for a torque scale that is not positive.
Wrenches grasp_matrix(std::span<const Contact> contacts, const Eigen::Vector3d& reference_point_O,
                      double torque_scale);

}  // namespace graspfit::contact
