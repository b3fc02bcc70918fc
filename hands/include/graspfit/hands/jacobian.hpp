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
/// and the angular velocity of its link, both in the frame O of the palm pose, while joint j alone
/// moves and the palm stands still [m, rad per rad or m]. Columns of joints that do not carry the
/// link are zero; a coupled joint has a column of its own, see `folded`. Rounded: the exact
/// derivative of `forward_kinematics`, no differences. Cost: linear in the links.
/// @throws InvalidInput for a link index or a number of joint positions that is not the model's.
Eigen::Matrix<double, 6, Eigen::Dynamic> point_jacobian(const HandModel& model,
                                                        const HandConfiguration& configuration,
                                                        int link, const Eigen::Vector3d& point_L);

/// Indices of the independent joints (the intrinsic DOFs), ascending.
std::vector<int> independent_joints(const HandModel& model);

/// Turns a matrix with one column per joint into one with one column per independent joint, in the
/// order of `independent_joints`: the columns of followers, times their ratios, are added to the
/// column of their leader.
///
/// A folded Jacobian is the derivative of `apply_couplings` followed by forward kinematics where no
/// follower is at its own limit or has broken away. Where one is, its column has to be left out.
/// @throws InvalidInput if the columns are not the model's joints.
Eigen::MatrixXd folded(const HandModel& model, const Eigen::MatrixXd& per_joint);

}  // namespace graspfit::hands
