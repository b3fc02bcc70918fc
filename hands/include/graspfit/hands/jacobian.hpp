#pragma once

#include <Eigen/Core>
#include <vector>

#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// Velocity of a point and angular velocity of its link in O, per unit of a joint's velocity.
struct JointVelocity {
  Eigen::Vector3d linear;
  Eigen::Vector3d angular;
};

/// Velocity that one joint gives a point that it carries. `X_OJ` is the pose of the joint's frame
/// or of its child link: the axis is fixed in both, so that the results differ by rounding only.
JointVelocity joint_velocity(const Joint& joint, const RigidTransform& X_OJ,
                             const Eigen::Vector3d& point_O);

/// Velocity of a point that is fixed to a link, per unit of every joint's velocity: 6 × joints.
///
/// Column j is [linear; angular]: the velocity of the point `point_L` (given in the link's frame)
/// and the angular velocity of its link, both in the frame O of the link poses `X_OL`, which
/// `forward_kinematics` gives, while joint j alone moves and the palm stands still [m, rad per rad
/// or m]. Columns of joints that do not carry the link are zero; a coupled joint has a column of
/// its own, see `folded`. Rounded: the exact derivative of `forward_kinematics`, no differences.
/// Cost: linear in the joints.
/// @throws InvalidInput for a link index or a number of poses that is not the model's.
Eigen::Matrix<double, 6, Eigen::Dynamic> point_jacobian(const HandModel& model,
                                                        const std::vector<RigidTransform>& X_OL,
                                                        int link, const Eigen::Vector3d& point_L);

/// Indices of the independent joints (the intrinsic DOFs), ascending.
std::vector<int> independent_joints(const HandModel& model);

/// Which followers (coupled joints) move with a small motion of their leaders. A follower that is
/// at its own limit moves one way only, so that derivatives have to choose.
enum class Followers {
  /// Every one, whatever its position and its limits are.
  All,
  /// Those that their leader puts (`led_position`) within their limits or onto one: a follower that
  /// stands exactly at its limit moves. One whose leader asks for more than a limit stays.
  WithinLimits,
  /// Those that stand strictly between their limits: a follower that stands at its limit stays,
  /// although its leader may be about to take it along. Where their leader puts them does not
  /// count.
  BetweenLimits,
  /// Those that stand where their leader puts them, to 1e-9 rad or m (the rounding of positions
  /// that were written as text, as in `validate`): one that is held by its limit, or has broken
  /// away, stays.
  InPlace,
};

/// Whether a coupled joint moves with a small motion of its leader, at joint positions `q`.
bool follows_leader(const HandModel& model, int joint, const Eigen::VectorXd& q,
                    Followers followers);

/// Velocity of a joint per unit of velocity of the joint that sets it (`leader_of`), at joint
/// positions `q`: 1 of an independent joint; of a follower the ratio of its coupling where
/// `follows_leader`, else 0.
double ratio_to_leader(const HandModel& model, int joint, const Eigen::VectorXd& q,
                       Followers followers);

/// Turns a matrix with one column per joint into one with one column per independent joint, in the
/// order of `independent_joints`: the columns of the followers that move, times their ratios, are
/// added to the column of their leader.
///
/// A folded Jacobian is the derivative of `apply_couplings` followed by forward kinematics, for
/// `InPlace` where no follower stands exactly at its limit; there it is a derivative to one side.
/// @throws InvalidInput if the columns or, unless `All` move, the positions `q` are not
/// the model's joints.
Eigen::MatrixXd folded(const HandModel& model, const Eigen::MatrixXd& per_joint,
                       const Eigen::VectorXd& q, Followers followers);

/// The same with all followers, wherever they stand (`Followers::All`).
Eigen::MatrixXd folded(const HandModel& model, const Eigen::MatrixXd& per_joint);

}  // namespace graspfit::hands
