#pragma once

#include <vector>

#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// Pose of every link in the frame in which the configuration's palm pose is given (O), in link
/// order. Rounded. Cost: linear in the links.
std::vector<RigidTransform> forward_kinematics(const HandModel& model,
                                               const HandConfiguration& configuration);

/// Pose of one link, given in `X_OL` that of its parent: a step of `forward_kinematics`, for those
/// who move few links of many.
RigidTransform link_pose(const HandModel& model, int link, const std::vector<RigidTransform>& X_OL,
                         const HandConfiguration& configuration);

/// Pose of a pad's frame, given the link poses.
inline RigidTransform pad_pose(const HandModel& model, int pad,
                               const std::vector<RigidTransform>& X_OL) {
  return X_OL[model.pads[pad].link] * model.pads[pad].X_LC;
}

/// The point of a pad that is meant to touch (`pad_contact_point_C`), given the link poses. Of a
/// flat pad exactly the origin of its frame.
Eigen::Vector3d pad_contact_point(const HandModel& model, int pad,
                                  const std::vector<RigidTransform>& X_OL);

/// Links that move when joint `joint` moves (children of its child link, through couplings of other
/// joints too), ascending.
std::vector<int> links_moved_by(const HandModel& model, int joint);

}  // namespace graspfit::hands
