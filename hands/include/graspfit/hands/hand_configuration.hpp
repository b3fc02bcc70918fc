#pragma once

#include <Eigen/Core>

#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// All that varies of a hand: where its palm is and what its joints read.
struct HandConfiguration {
  RigidTransform X_OH = RigidTransform::Identity();  ///< Palm (root link) pose in the object frame.
  Eigen::VectorXd q;  ///< One position per joint of the model, coupled ones included [rad or m].
};

/// Every joint at the limit that opens the hand (`closing_sign`), neutral ones (spread, abduction)
/// at the value nearest zero; coupled joints follow.
HandConfiguration open_configuration(const HandModel& model);

/// Every joint that closes the hand at `share` of the way from open (0) to the limit that closes it
/// (1), neutral ones as in `open_configuration`; coupled joints follow. Fingers may pass through
/// each other: `closed_without_overlap` stops them. @throws InvalidInput unless 0 ≤ share ≤ 1.
HandConfiguration closed_configuration(const HandModel& model, double share);

/// Where the leader puts a joint, whatever its own limits are.
double led_position(const Coupling& coupling, const Eigen::VectorXd& q);

/// Where a coupled joint stands as long as it follows: there, clamped to its limits.
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
