#include "graspfit/hands/jacobian.hpp"

#include <Eigen/Geometry>

#include "graspfit/base/errors.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/kinematic_chain.hpp"

namespace graspfit::hands {

JointVelocity joint_velocity(const Joint& joint, const RigidTransform& X_OJ,
                             const Eigen::Vector3d& point_O) {
  const Eigen::Vector3d axis_O = X_OJ.linear() * joint.axis_J;
  if (joint.type == JointType::Prismatic) return {axis_O, Eigen::Vector3d::Zero()};
  return {axis_O.cross(point_O - X_OJ.translation()), axis_O};
}

Eigen::Matrix<double, 6, Eigen::Dynamic> point_jacobian(const HandModel& model,
                                                        const HandConfiguration& configuration,
                                                        int link, const Eigen::Vector3d& point_L) {
  if (link < 0 || link >= std::ssize(model.links)) {
    throw base::InvalidInput("hand " + model.name + ": link " + std::to_string(link) + " of " +
                             std::to_string(model.links.size()));
  }
  const std::vector<RigidTransform> X_OL = forward_kinematics(model, configuration);
  const Eigen::Vector3d point_O = X_OL[link] * point_L;
  Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian =
      Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, std::ssize(model.joints));
  for (const int index : joints_to(model, link)) {
    const Joint& joint = model.joints[index];
    const JointVelocity velocity = joint_velocity(joint, X_OL[joint.child_link], point_O);
    jacobian.col(index) << velocity.linear, velocity.angular;
  }
  return jacobian;
}

std::vector<int> independent_joints(const HandModel& model) {
  std::vector<int> joints;
  for (int j = 0; j < std::ssize(model.joints); ++j) {
    if (!model.joints[j].coupling) joints.push_back(j);
  }
  return joints;
}

Eigen::MatrixXd folded(const HandModel& model, const Eigen::MatrixXd& per_joint) {
  if (per_joint.cols() != std::ssize(model.joints)) {
    throw base::InvalidInput("hand " + model.name + ": " + std::to_string(per_joint.cols()) +
                             " columns for " + std::to_string(model.joints.size()) + " joints");
  }
  const std::vector<int> independent = independent_joints(model);
  Eigen::MatrixXd result(per_joint.rows(), std::ssize(independent));
  for (int k = 0; k < std::ssize(independent); ++k) {
    auto column = result.col(k);
    column = per_joint.col(independent[k]);
    for (int j = 0; j < std::ssize(model.joints); ++j) {
      const std::optional<Coupling>& coupling = model.joints[j].coupling;
      if (coupling && coupling->leader == independent[k]) {
        column += coupling->ratio * per_joint.col(j);
      }
    }
  }
  return result;
}

}  // namespace graspfit::hands
