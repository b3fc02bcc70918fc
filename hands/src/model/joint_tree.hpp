#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <vector>

#include "graspfit/base/as_index.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands::internal {

using Eigen::Vector3d;

/// The order of the movable joints in a hand's tree; links that fixed joints join count as one.
class JointTree {
 public:
  explicit JointTree(const HandModel& tree) : tree_(tree), above_(tree.links.size()) {
    for (std::size_t i = 1; i < tree_.links.size(); ++i) {
      const Link& link = tree_.links[i];
      above_[i] = link.parent_joint ? link.parent_joint : above_[*link.parent_link];
    }
    const HandConfiguration zero{.X_OH = RigidTransform::Identity(),
                                 .q = Eigen::VectorXd::Zero(std::ssize(tree_.joints))};
    X_HL_ = forward_kinematics(tree_, zero);
  }

  const HandModel& tree() const { return tree_; }
  const Joint& joint(int j) const { return tree_.joints[j]; }
  int num_joints() const { return base::as_index<int>(tree_.joints.size()); }

  /// The joint that moves a link; empty for the root and links fixed to it.
  std::optional<int> above_link(int link) const { return above_[link]; }
  /// The joint before a joint, if there is one.
  std::optional<int> above(int j) const { return above_[joint(j).parent_link]; }
  /// The joints next after a joint; without a joint, those on the root.
  std::vector<int> next(std::optional<int> j) const {
    std::vector<int> result;
    for (int k = 0; k < num_joints(); ++k) {
      if (above(k) == j) result.push_back(k);
    }
    return result;
  }

  /// A point on a joint's axis and its direction while all joints are at zero, in the root link's
  /// frame.
  Vector3d point(int j) const { return X_HJ(j).translation(); }
  Vector3d axis(int j) const { return X_HJ(j).linear() * joint(j).axis_J; }
  bool are_parallel(int a, int b) const {
    constexpr double kParallel = 0.02;  // [rad]; axes of one plane of flexion, measured on CAD
    return axis(a).cross(axis(b)).norm() < kParallel;
  }

  double range(int j) const { return joint(j).upper - joint(j).lower; }
  /// Whether the joint follows no other joint, and none follows it.
  bool is_free(int j) const {
    return !joint(j).coupling &&
           std::none_of(tree_.joints.begin(), tree_.joints.end(), [&](const Joint& other) {
             return other.coupling && other.coupling->leader == j;
           });
  }
  bool is_revolute(int j) const { return joint(j).type == JointType::Revolute; }

 private:
  RigidTransform X_HJ(int j) const { return X_HL_[joint(j).parent_link] * joint(j).X_PJ; }

  const HandModel& tree_;
  std::vector<std::optional<int>> above_;
  std::vector<RigidTransform> X_HL_;
};

}  // namespace graspfit::hands::internal
