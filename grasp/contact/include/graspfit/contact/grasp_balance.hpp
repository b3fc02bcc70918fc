#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "graspfit/contact/contact.hpp"
#include "graspfit/contact/wrench.hpp"

namespace graspfit::contact {

/// Cones and bounds of a balance of forces.
struct BalanceOptions {
  int num_cone_edges = 8;         ///< Edges per inscribed friction cone, ≥ 3.
  double friction = 1.0;          ///< Coulomb's μ of all contacts, ≥ 0.
  double least_normal_sum = 0.0;  ///< The normal forces sum up to at least this [N], ≥ 0: how hard
                                  ///< the hand squeezes. Zero allows no force at all.
  /// Length that divides torques [m], > 0. Required, since it weighs them in the residual:
  /// `validate` refuses options without one.
  std::optional<double> torque_scale = std::nullopt;
  /// Weight of the forces α along the cone edges beside the residual, ≥ 0: ‖residual‖² + evenness²
  /// Σ α² is minimized. Above zero the forces are unique, spread evenly and as symmetric as the
  /// contacts, and the residual exceeds the least one by at most evenness times the sum of the
  /// normal forces.
  double evenness = 0.0;
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// Contact forces whose wrench comes nearest to a load.
struct BalanceForces {
  Eigen::Matrix3Xd forces_O;    ///< Force of each contact on the object [N].
  Eigen::VectorXd edge_forces;  ///< Normal force along each cone edge, contact by contact [N], ≥ 0.
  Wrench residual = Wrench::Zero();  ///< Wrench of the contacts minus the load [N].
  double residual_norm = 0.0;  ///< Length of `residual`; 0 where the contacts balance the load [N].
  double normal_sum = 0.0;     ///< Sum of all normal forces [N].
};

/// Minimizes ‖Σ w − load‖ over forces in the linearized cones whose normal parts sum up to at least
/// `least_normal_sum`, where Σ w is the wrench of the contacts about the reference point. To hold
/// an object, `load` is minus the wrench that pulls at it. Without contacts there are no forces.
///
/// The residual is unique, but the forces often are not: those returned act along few cone edges,
/// unless `evenness` spreads them. The result is approximate, to about 1e-12 of the load and the
/// bound [Lawson & Hanson 1974, chapter 23].
/// @throws InvalidInput for options out of range, a normal that is not unit within 1e-6, numbers
/// that are not finite, and a positive bound without contacts.
BalanceForces balance_forces(std::span<const Contact> contacts,
                             const Eigen::Vector3d& reference_point_O, const Wrench& load,
                             const BalanceOptions& options);

}  // namespace graspfit::contact
