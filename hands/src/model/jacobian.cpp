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
  if (link < 0 || link >= static_cast<int>(model.links.size())) {
    throw base::InvalidInput("hand " + model.name + ": link " + std::to_string(link) + " of " +
                             std::to_string(model.links.size()));
  }
  const std::vector<RigidTransform> X_OL = forward_kinematics(model, configuration);
  const Eigen::Vector3d point_O = X_OL[link] * point_L;
  Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian =
      Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(
          6, static_cast<Eigen::Index>(model.joints.size()));
  for (const int index : joints_to(model, link)) {
    const Joint& joint = model.joints[index];
    const JointVelocity velocity = joint_velocity(joint, X_OL[joint.child_link], point_O);
    jacobian.col(index) << velocity.linear, velocity.angular;
  }
  return jacobian;
}

std::vector<int> independent_joints(const HandModel& model) {
  std::vector<int> joints;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    if (!model.joints[j].coupling) joints.push_back(static_cast<int>(j));
  }
  return joints;
}

Eigen::MatrixXd folded(const HandModel& model, const Eigen::MatrixXd& per_joint) {
  if (per_joint.cols() != static_cast<Eigen::Index>(model.joints.size())) {
    throw base::InvalidInput("hand " + model.name + ": " + std::to_string(per_joint.cols()) +
                             " columns for " + std::to_string(model.joints.size()) + " joints");
  }
  const std::vector<int> independent = independent_joints(model);
  Eigen::MatrixXd result(per_joint.rows(), static_cast<Eigen::Index>(independent.size()));
  for (std::size_t k = 0; k < independent.size(); ++k) {
    auto column = result.col(static_cast<Eigen::Index>(k));
    column = per_joint.col(independent[k]);
    for (std::size_t j = 0; j < model.joints.size(); ++j) {
      const std::optional<Coupling>& coupling = model.joints[j].coupling;
      if (coupling && coupling->leader == independent[k]) {
        column += coupling->ratio * per_joint.col(static_cast<Eigen::Index>(j));
      }
    }
  }
  return result;
}

}  // namespace graspfit::hands
