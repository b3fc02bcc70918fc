#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "graspfit/grasp/contact.hpp"
#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::grasp {

/// How hard a hand is commanded to press.
struct SqueezeOptions {
  double normal_sum = 10.0;  ///< Sum of the normal forces of all contacts [N], > 0.
  double stiffness = 5.0;    ///< kp of the position-controlled joints [N m/rad, or N/m for slides
                             ///< times 1 m^-2], > 0; DexGraspBench's 5.
  double largest_residual = 0.05;  ///< Wrench that may stay unbalanced over normal_sum, ≥ 0.
  void validate() const;           ///< Throws InvalidInput naming the field and its value.
};

/// The commanded configuration beyond the surface.
struct Squeeze {
  hands::HandConfiguration configuration;  ///< The grasp's palm pose; joints commanded, clamped to
                                           ///< their limits.
  Eigen::Matrix3Xd forces_O;               ///< Per contact, on the object [N].
  double residual = 0.0;     ///< Unbalanced wrench over normal_sum (torques over the torque scale).
  bool is_balanced = false;  ///< residual ≤ largest_residual.
  bool is_clamped = false;   ///< Some joint would have to be commanded beyond its limits.
};

/// Joint displacement Δq = Jᵀ f / kp, where f are contact forces that balance one another (no load)
/// within their cones and press with `normal_sum` in all (`balance_forces`; evaluation of the
/// field: Δq = Jᵀ f / kp). Coupled joints follow their leaders, whose column takes up theirs. Where
/// contacts cannot balance, the forces of least residual are used and it is said.
/// `friction` is Coulomb's μ, ≥ 0; `torque_scale` divides torques in the residual [m], > 0.
/// @throws InvalidInput for bad options or contacts of links that the hand does not have; fewer
/// than one contact.
Squeeze squeeze_configuration(const hands::HandModel& hand, const hands::HandConfiguration& grasp,
                              std::span<const Contact> contacts,
                              const Eigen::Vector3d& center_of_mass_O, double torque_scale,
                              double friction, const SqueezeOptions& options = {});

}  // namespace graspfit::grasp
