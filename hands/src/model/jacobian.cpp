#include "graspfit/hands/jacobian.hpp"

#include <Eigen/Geometry>

#include "graspfit/base/errors.hpp"
#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::hands {

Eigen::Matrix<double, 6, Eigen::Dynamic> point_jacobian(const HandModel& model,
                                                        const HandConfiguration& configuration,
                                                        int link, const Eigen::Vector3d& point_L) {
  if (link < 0 || link >= static_cast<int>(model.links.size())) {
    throw base::InvalidInput("hand " + model.name + ": link " + std::to_string(link) + " of " +
                             std::to_string(model.links.size()));
  }
  const std::vector<RigidTransform> X_OL = forward_kinematics(model, configuration);
  const Eigen::Vector3d point_O = X_OL[static_cast<std::size_t>(link)] * point_L;
  Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian =
      Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(
          6, static_cast<Eigen::Index>(model.joints.size()));
  for (int at = link; at >= 0; at = model.links[static_cast<std::size_t>(at)].parent_link) {
    const int index = model.links[static_cast<std::size_t>(at)].parent_joint;
    if (index < 0) continue;
    const Joint& joint = model.joints[static_cast<std::size_t>(index)];
    // The axis is fixed to both sides of the joint, so that the child's pose serves.
    const RigidTransform& X_OJ = X_OL[static_cast<std::size_t>(at)];
    const Eigen::Vector3d axis_O = X_OJ.linear() * joint.axis_J;
    if (joint.type == JointType::Prismatic) {
      jacobian.col(index).head<3>() = axis_O;
    } else {
      jacobian.col(index).head<3>() = axis_O.cross(point_O - X_OJ.translation());
      jacobian.col(index).tail<3>() = axis_O;
    }
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
