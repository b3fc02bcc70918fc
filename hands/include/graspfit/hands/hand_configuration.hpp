#pragma once

#include <Eigen/Core>

#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// All that varies of a hand: the pose of its palm and the positions of its joints.
struct HandConfiguration {
  RigidTransform X_OH = RigidTransform::Identity();  ///< Palm (root link) pose in the object frame.
  Eigen::VectorXd q;  ///< One position per joint of the model, coupled ones included [rad or m].
};

/// The open hand. Every joint that opens or closes it (`closing_sign`) is at its open limit,
/// neutral joints (spread, abduction) are at the value nearest zero, and coupled joints follow.
HandConfiguration open_configuration(const HandModel& model);

/// The hand closed by `share`. Every joint that closes it is at `share` of the range from its open
/// limit (0) to its closed limit (1), neutral joints are as in `open_configuration`, and coupled
/// joints follow. Fingers may pass through each other here, but not in `closed_without_overlap`.
/// @throws InvalidInput unless 0 ≤ share ≤ 1.
HandConfiguration closed_configuration(const HandModel& model, double share);

/// Position that a coupling gives a joint: ratio · q[leader] + offset. The joint's own limits do
/// not count.
double led_position(const Coupling& coupling, const Eigen::VectorXd& q);

/// Position of a coupled joint that follows its leader: `led_position`, clamped to the joint's
/// limits.
double followed_position(const Joint& joint, const Eigen::VectorXd& q);

/// Sets every coupled joint from its leader, clamped to its own limits, except that a breakaway
/// joint keeps a position that is further closed than its coupling asks for.
void apply_couplings(const HandModel& model, Eigen::VectorXd& q);

/// Clamps every joint to its limits.
void clamp_to_limits(const HandModel& model, Eigen::VectorXd& q);

/// Throws InvalidInput (joint, value, limits) if sizes differ or a joint leaves its limits by more
/// than 1e-9.
void validate(const HandModel& model, const HandConfiguration& configuration);

}  // namespace graspfit::hands
