#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::testing {

/// The bounding box of a hand's links where a configuration has them, in O: of those that `counts`
/// says, given by index; without it of all.
inline Eigen::AlignedBox3d posed_box(const hands::HandModel& hand,
                                     const hands::HandConfiguration& configuration,
                                     const std::function<bool(int link)>& counts = {}) {
  Eigen::AlignedBox3d box;
  const std::vector<hands::RigidTransform> X_OL = hands::forward_kinematics(hand, configuration);
  for (std::size_t link = 0; link < X_OL.size(); ++link) {
    if (counts && !counts(static_cast<int>(link))) continue;
    for (const Eigen::Vector3d& vertex : hand.links[link].mesh_L.vertices) {
      box.extend(Eigen::Vector3d(X_OL[link] * vertex));
    }
  }
  return box;
}

}  // namespace graspfit::testing
