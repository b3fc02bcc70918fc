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

/// Whether the matrix of a pose is orthogonal up to rounding: the entries of its product with its
/// transpose are those of the identity to 5e-14, as those of a hundred poses in a row are. It then
/// makes no vector longer by more than 7.5e-14 of its length, and what is seen along the axes of
/// the other frame is as far apart as it is to 5e-13 of the coordinates.
inline bool is_rotation(const RigidTransform& X) {
  return (X.linear().transpose() * X.linear()).isIdentity(5e-14);
}

}  // namespace graspfit::geometry
