#pragma once

#include <Eigen/Geometry>

#include "graspfit/base/floating_point.hpp"

namespace graspfit::geometry {

/// A rigid motion. `X_AB` is the pose of frame B in frame A: `p_A = X_AB * p_B`.
///
/// Products read by matching letters: `X_OL = X_OH * X_HL`. Frames of the toolkit: W world,
/// O object, H hand base (palm), L link, C contact. Lengths in meters.
///
/// `inverse()` takes the transpose of the matrix, which is its inverse only for a rotation. Poses
/// that people write with few digits are none; what decides exactly about a mesh in a pose does not
/// rely on it (`is_rotation`).
using RigidTransform = Eigen::Isometry3d;

/// Whether the matrix of a pose is orthogonal up to rounding (1e-12).
inline bool is_rotation(const RigidTransform& X) {
  return (X.linear().transpose() * X.linear()).isIdentity(1e-12);
}

}  // namespace graspfit::geometry
