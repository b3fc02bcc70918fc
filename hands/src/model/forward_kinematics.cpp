#include "graspfit/hands/forward_kinematics.hpp"

#include "graspfit/base/errors.hpp"

namespace graspfit::hands {

namespace {

/// Motion of a joint by position `q`, in its joint frame.
RigidTransform motion(const Joint& joint, double q) {
  RigidTransform X = RigidTransform::Identity();
  if (joint.type == JointType::Revolute) {
    X.linear() = Eigen::AngleAxisd(q, joint.axis_J).toRotationMatrix();
  } else {
    X.translation() = q * joint.axis_J;
  }
  return X;
}

}  // namespace

RigidTransform link_pose(const HandModel& model, int link, const std::vector<RigidTransform>& X_OL,
                         const HandConfiguration& configuration) {
  const Link& description = model.links[link];
  if (!description.parent_link) return configuration.X_OH;
  const RigidTransform& X_OP = X_OL[*description.parent_link];
  if (!description.parent_joint) return X_OP * description.X_PL_fixed;
  const Joint& joint = model.joints[*description.parent_joint];
  return X_OP * joint.X_PJ * motion(joint, configuration.q[*description.parent_joint]);
}

std::vector<RigidTransform> forward_kinematics(const HandModel& model,
                                               const HandConfiguration& configuration) {
  if (configuration.q.size() != std::ssize(model.joints)) {
    throw base::InvalidInput("hand " + model.name + ": " + std::to_string(configuration.q.size()) +
                             " joint positions for " + std::to_string(model.joints.size()) +
                             " joints");
  }
  if (!configuration.q.allFinite() || !configuration.X_OH.matrix().allFinite()) {
    throw base::InvalidInput("hand " + model.name +
                             ": palm pose or joint positions are not finite");
  }
  std::vector<RigidTransform> X_OL(model.links.size());
  for (int i = 0; i < std::ssize(model.links); ++i) {
    X_OL[i] = link_pose(model, i, X_OL, configuration);
  }
  return X_OL;
}

Eigen::Vector3d pad_contact_point(const HandModel& model, int pad,
                                  const std::vector<RigidTransform>& X_OL) {
  const RigidTransform X_OC = pad_pose(model, pad, X_OL);
  return X_OC.translation() + pad_contact_point_C(model.pads[pad]).z() * X_OC.linear().col(2);
}

std::vector<int> links_moved_by(const HandModel& model, int joint) {
  if (joint < 0 || joint >= std::ssize(model.joints)) {
    throw base::InvalidInput("hand " + model.name + ": joint " + std::to_string(joint) + " of " +
                             std::to_string(model.joints.size()));
  }
  std::vector<int> moved;
  std::vector<bool> moves(model.links.size(), false);
  for (int i = 0; i < std::ssize(model.links); ++i) {
    const Link& link = model.links[i];
    if (!link.parent_link) continue;
    moves[i] = moves[*link.parent_link];
    if (link.parent_joint) {
      const Joint& own = model.joints[*link.parent_joint];
      moves[i] = moves[i] || link.parent_joint == joint ||
                 (own.coupling && own.coupling->leader == joint && own.coupling->ratio != 0.0);
    }
    if (moves[i]) moved.push_back(i);
  }
  return moved;
}

}  // namespace graspfit::hands
