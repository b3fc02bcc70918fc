#pragma once

#include <Eigen/Geometry>

#include "description/robot_description.hpp"

namespace graspfit::hands::internal {

/// How far joint position `q` moves the child link from the joint's frame; the identity for fixed
/// joints.
inline geometry::RigidTransform joint_motion(const DescribedJoint& joint, double q) {
  geometry::RigidTransform X = geometry::RigidTransform::Identity();
  switch (joint.type) {
    case DescribedJoint::Type::Fixed:
      break;
    case DescribedJoint::Type::Revolute:
    case DescribedJoint::Type::Continuous:
      X.linear() = Eigen::AngleAxisd(q, joint.axis).toRotationMatrix();
      break;
    case DescribedJoint::Type::Prismatic:
      X.translation() = q * joint.axis;
      break;
  }
  return X;
}

}  // namespace graspfit::hands::internal
