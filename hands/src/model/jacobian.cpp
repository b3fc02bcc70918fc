#include "graspfit/hands/jacobian.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "graspfit/base/errors.hpp"
#include "graspfit/hands/kinematic_chain.hpp"

namespace graspfit::hands {

JointVelocity joint_velocity(const Joint& joint, const RigidTransform& X_OJ,
                             const Eigen::Vector3d& point_O) {
  const Eigen::Vector3d axis_O = X_OJ.linear() * joint.axis_J;
  if (joint.type == JointType::Prismatic) return {axis_O, Eigen::Vector3d::Zero()};
  return {axis_O.cross(point_O - X_OJ.translation()), axis_O};
}

Eigen::Matrix<double, 6, Eigen::Dynamic> point_jacobian(const HandModel& model,
                                                        const std::vector<RigidTransform>& X_OL,
                                                        int link, const Eigen::Vector3d& point_L) {
  if (link < 0 || link >= std::ssize(model.links)) {
    throw base::InvalidInput("hand " + model.name + ": link " + std::to_string(link) + " of " +
                             std::to_string(model.links.size()));
  }
  if (X_OL.size() != model.links.size()) {
    throw base::InvalidInput("hand " + model.name + ": " + std::to_string(X_OL.size()) +
                             " link poses for " + std::to_string(model.links.size()) + " links");
  }
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

bool follows_leader(const HandModel& model, int joint, const Eigen::VectorXd& q,
                    Followers followers) {
  constexpr double kSlack = 1e-9;  // [rad or m], see `Followers::InPlace`
  const Joint& follower = model.joints[joint];
  if (!follower.coupling) return false;
  switch (followers) {
    case Followers::All:
      return true;
    case Followers::WithinLimits: {
      const double led = led_position(*follower.coupling, q);
      return !(led < follower.lower || led > follower.upper);
    }
    case Followers::BetweenLimits:
      return !(q[joint] <= follower.lower || q[joint] >= follower.upper);
    case Followers::InPlace:
      return std::abs(q[joint] - led_position(*follower.coupling, q)) <= kSlack;
  }
  return true;
}

double ratio_to_leader(const HandModel& model, int joint, const Eigen::VectorXd& q,
                       Followers followers) {
  const std::optional<Coupling>& coupling = model.joints[joint].coupling;
  if (!coupling) return 1.0;
  return follows_leader(model, joint, q, followers) ? coupling->ratio : 0.0;
}

Eigen::MatrixXd folded(const HandModel& model, const Eigen::MatrixXd& per_joint,
                       const Eigen::VectorXd& q, Followers followers) {
  const auto require_joints = [&](Eigen::Index given, const char* what) {
    if (given == std::ssize(model.joints)) return;
    throw base::InvalidInput("hand " + model.name + ": " + std::to_string(given) + what +
                             std::to_string(model.joints.size()) + " joints");
  };
  require_joints(per_joint.cols(), " columns for ");
  if (followers != Followers::All) require_joints(q.size(), " joint positions for ");
  const std::vector<int> independent = independent_joints(model);
  Eigen::MatrixXd result(per_joint.rows(), std::ssize(independent));
  for (int k = 0; k < std::ssize(independent); ++k) {
    auto column = result.col(k);
    column = per_joint.col(independent[k]);
    for (int j = 0; j < std::ssize(model.joints); ++j) {
      const std::optional<Coupling>& coupling = model.joints[j].coupling;
      if (!coupling || coupling->leader != independent[k]) continue;
      if (follows_leader(model, j, q, followers)) column += coupling->ratio * per_joint.col(j);
    }
  }
  return result;
}

Eigen::MatrixXd folded(const HandModel& model, const Eigen::MatrixXd& per_joint) {
  return folded(model, per_joint, {}, Followers::All);
}

}  // namespace graspfit::hands
