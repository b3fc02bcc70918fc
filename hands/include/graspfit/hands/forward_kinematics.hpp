#pragma once

#include <vector>

#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// Pose of every link in the frame in which the configuration's palm pose is given (O), in link
/// order. Rounded. Cost: linear in the links.
/// @throws InvalidInput for a wrong number of joint positions, and where they or the palm's pose
/// are not finite.
std::vector<RigidTransform> forward_kinematics(const HandModel& model,
                                               const HandConfiguration& configuration);

/// A configuration with the link poses that `forward_kinematics` gives there, for work of several
/// steps on one configuration. Refers to both.
struct PosedConfiguration {
  const HandConfiguration& configuration;
  const std::vector<RigidTransform>& X_OL;
};

/// Pose of one link, computed from the pose of its parent link in `X_OL`. This is one step of
/// `forward_kinematics`, for callers that move only a few of many links.
RigidTransform link_pose(const HandModel& model, int link, const std::vector<RigidTransform>& X_OL,
                         const HandConfiguration& configuration);

/// Pose of a pad's frame, given the link poses.
inline RigidTransform pad_pose(const HandModel& model, int pad,
                               const std::vector<RigidTransform>& X_OL) {
  return X_OL[model.pads[pad].link] * model.pads[pad].X_LC;
}

/// The contact point of a pad (`pad_contact_point_C`) in O, given the link poses. For a flat pad it
/// is exactly the origin of the pad's frame.
Eigen::Vector3d pad_contact_point(const HandModel& model, int pad,
                                  const std::vector<RigidTransform>& X_OL);

/// Indices of the links that move when joint `joint` moves, ascending: its child link, the child
/// links of the joints that follow it by a coupling, and all links below these.
std::vector<int> links_moved_by(const HandModel& model, int joint);

}  // namespace graspfit::hands
