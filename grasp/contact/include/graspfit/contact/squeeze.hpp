#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "graspfit/contact/contact.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::contact {

/// How hard a hand is commanded to press.
struct SqueezeOptions {
  double normal_sum = 20.0;  ///< Sum of the normal forces of all contacts [N], > 0.
  double stiffness = 5.0;    ///< kp of position-controlled revolute joints [N m/rad], > 0; the
                             ///< default is DexGraspBench's.
  double slide_stiffness = 2000.0;  ///< kp of slides [N/m], > 0; the default is ours: for 10 N a
                                    ///< jaw is commanded 5 mm beyond contact, a travel that jaws
                                    ///< closed on anything thicker have left.
  double largest_residual = 0.05;   ///< Largest unbalanced wrench over normal_sum of a balanced
                                    ///< squeeze, ≥ 0.
  void validate() const;            ///< Throws InvalidInput naming the field and its value.
};

/// Properties of the object and of its contacts that a squeeze depends on.
struct SqueezeContext {
  Eigen::Vector3d center_of_mass_O = Eigen::Vector3d::Zero();  ///< Torques are about it [m].
  /// Length that divides torques in the residual [m], > 0. Required: without one a squeeze is
  /// refused.
  std::optional<double> torque_scale = std::nullopt;
  double friction = 1.0;  ///< Coulomb's μ of all contacts, ≥ 0.
  /// Contacts with a larger gap bear no force [m]; empty: all contacts do.
  std::optional<double> bearing_gap = std::nullopt;
};

/// The commanded configuration beyond the surface.
struct Squeeze {
  hands::HandConfiguration configuration;  ///< The grasp's palm pose; joints commanded, clamped to
                                           ///< their limits.
  Eigen::Matrix3Xd forces_O;  ///< Force of each contact on the object [N]; zero where the pad does
                              ///< not touch.
  double residual = 0.0;     ///< Unbalanced wrench over normal_sum (torques over the torque scale).
  bool is_balanced = false;  ///< residual ≤ largest_residual.
  bool is_clamped = false;   ///< Some joint would have to be commanded beyond its limits, so that
                             ///< it presses less than `forces_O` say.
};

/// Commands the joint displacement Δq = Jᵀ f / kp, as evaluations in the field do, where f are
/// contact forces on the object that balance one another within their friction cones (eight edges,
/// no load) and press with `normal_sum` in all. A joint that stands `Δq` short of its command
/// exerts the torque or force that these need, so it presses the contacts in the directions of f.
///
/// Of all such forces those spread most evenly are taken (`BalanceOptions::evenness` 1e-3: the
/// residual is at most 1e-3 above the least). They are unique, and symmetric where the contacts
/// are. Where contacts cannot balance, the forces of least residual are used, and `residual` says
/// so. Palm contacts take their share of the forces and need no joint torque.
///
/// kp belongs to the independent joints: the torque of a leader includes those of its followers
/// (the joints coupled to it), times their ratios, and followers move with its command. A follower
/// that does not stand where its leader puts it (it stands at a limit, or has broken away) adds no
/// torque and does not move until its leader takes it along.
///
/// @throws InvalidInput for bad options, a torque scale or a friction out of range, a configuration
/// outside the hand's limits, a number of link poses that is not the hand's, no contact that bears
/// a force, and contacts of links that the hand does not have or with normals that are not unit.
Squeeze squeeze_configuration(const hands::HandModel& hand, const hands::PosedConfiguration& grasp,
                              std::span<const Contact> contacts, const SqueezeContext& context,
                              const SqueezeOptions& options = {});

/// The same for a configuration whose link poses are not known yet.
Squeeze squeeze_configuration(const hands::HandModel& hand, const hands::HandConfiguration& grasp,
                              std::span<const Contact> contacts, const SqueezeContext& context,
                              const SqueezeOptions& options = {});

}  // namespace graspfit::contact
