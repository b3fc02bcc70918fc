#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "graspfit/contact/contact.hpp"
#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::contact {

/// How hard a hand is commanded to press.
struct SqueezeOptions {
  double normal_sum = 20.0;         ///< Sum of the normal forces of all contacts [N], > 0.
  double stiffness = 5.0;           ///< kp of position-controlled revolute joints [N m/rad], > 0;
                                    ///< DexGraspBench's.
  double slide_stiffness = 2000.0;  ///< kp of slides [N/m], > 0; ours: 10 N of a jaw press 5 mm
                                    ///< deep, which jaws closed on anything thicker have left.
  double largest_residual = 0.05;   ///< Wrench that may stay unbalanced over normal_sum, ≥ 0.
  void validate() const;            ///< Throws InvalidInput naming the field and its value.
};

/// The commanded configuration beyond the surface.
struct Squeeze {
  hands::HandConfiguration configuration;  ///< The grasp's palm pose; joints commanded, clamped to
                                           ///< their limits.
  Eigen::Matrix3Xd forces_O;               ///< Per contact, on the object [N]; zero where the pad
                                           ///< does not touch.
  double residual = 0.0;     ///< Unbalanced wrench over normal_sum (torques over the torque scale).
  bool is_balanced = false;  ///< residual ≤ largest_residual.
  bool is_clamped = false;   ///< Some joint would have to be commanded beyond its limits, so that
                             ///< it presses less than `forces_O` say.
};

/// Joint displacement Δq = Jᵀ f / kp (evaluation of the field), where f are contact forces on the
/// object that balance one another within their friction cones (eight edges, no load) and press
/// with `normal_sum` in all. A joint that stands `Δq` short of its command exerts what the forces
/// ask of it, so it presses the contacts in the directions of f.
///
/// Of all such forces those spread most evenly (`BalanceOptions::evenness` 1e-3: the residual is at
/// most 1e-3 above the least): unique, symmetric where the contacts are. Where contacts cannot
/// balance, the forces of least residual are used, and `residual` says so. Palm contacts take their
/// share of the forces and ask nothing of the joints.
///
/// kp belongs to the independent joints: a leader's torque takes up its followers', times their
/// ratio, and they follow its command. A follower that does not stand where its leader puts it (it
/// stands at a limit, or has broken away) neither counts nor moves until its leader takes it along.
///
/// `friction` is Coulomb's μ, ≥ 0; `torque_scale` divides torques in the residual [m], > 0.
/// Contacts with a gap above `bearing_gap` [m] bear nothing; without it all do.
/// @throws InvalidInput for bad options, a configuration outside the hand's limits, no contact that
/// bears anything, and contacts of links that the hand does not have or with normals that are not
/// unit.
Squeeze squeeze_configuration(const hands::HandModel& hand, const hands::HandConfiguration& grasp,
                              std::span<const Contact> contacts,
                              const Eigen::Vector3d& center_of_mass_O, double torque_scale,
                              double friction, const SqueezeOptions& options = {},
                              const std::optional<double>& bearing_gap = std::nullopt);

}  // namespace graspfit::contact
