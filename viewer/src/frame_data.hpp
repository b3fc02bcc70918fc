#pragma once

#include <vector>

#include "graspfit/geometry/rigid_transform.hpp"

namespace graspfit::viewer::internal {

// A pose in a list of frames: x, y, z and the unit quaternion w, x, y, z.
inline void append_pose(const geometry::RigidTransform& X, std::vector<float>& numbers) {
  const Eigen::Quaterniond turn(X.linear());
  for (const double x : {X.translation().x(), X.translation().y(), X.translation().z(), turn.w(),
                         turn.x(), turn.y(), turn.z()}) {
    numbers.push_back(static_cast<float>(x));
  }
}

}  // namespace graspfit::viewer::internal
