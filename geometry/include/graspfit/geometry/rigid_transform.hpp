#pragma once

#include <Eigen/Geometry>

namespace graspfit::geometry {

/// A rigid motion. `X_AB` is the pose of frame B in frame A: `p_A = X_AB * p_B`.
///
/// Products read by matching letters: `X_OL = X_OH * X_HL`. Frames of the toolkit: W world,
/// O object, H hand base (palm), L link, C contact. Lengths in meters.
using RigidTransform = Eigen::Isometry3d;

}  // namespace graspfit::geometry
