#pragma once

#include <Eigen/Geometry>
#include <array>

#include "graspfit/base/floating_point.hpp"

namespace graspfit::geometry {

/// A rigid motion. `X_AB` is the pose of frame B in frame A: `p_A = X_AB * p_B`.
///
/// Products read by matching letters: `X_OL = X_OH * X_HL`. Frames of the toolkit: W world,
/// O object, H hand base (palm), L link, C contact. Lengths in meters.
///
/// `inverse()` takes the transpose of the matrix, which is its inverse only for a rotation. Poses
/// that people write with few digits are none: where a mesh in a pose is decided about, `inverted`
/// and `relative_pose` are used.
using RigidTransform = Eigen::Isometry3d;

/// Whether the matrix of a pose is orthogonal up to rounding: the entries of its product with its
/// transpose are those of the identity to 5e-14, as those of a hundred poses in a row are. It then
/// makes no vector longer by more than 7.5e-14 of its length, and what is seen along the axes of
/// the other frame is as far apart as it is to 5e-13 of the coordinates.
inline bool is_rotation(const RigidTransform& X) {
  return (X.linear().transpose() * X.linear()).isIdentity(5e-14);
}

/// The inverse of a pose: the transpose of its matrix if that `is_rotation`, else the matrix's own
/// inverse. Rounded.
inline RigidTransform inverted(const RigidTransform& X) {
  if (is_rotation(X)) return X.inverse();
  RigidTransform inverse = RigidTransform::Identity();
  inverse.linear() = X.linear().inverse();
  inverse.translation() = -(inverse.linear() * X.translation());
  return inverse;
}

/// X_AB, the pose of frame B in frame A, of two poses in one frame. Rounded.
inline RigidTransform relative_pose(const RigidTransform& X_OA, const RigidTransform& X_OB) {
  return inverted(X_OA) * X_OB;
}

/// The rotation of a pose as files state it: a unit quaternion (w, x, y, z) with w ≥ 0; of the two
/// with w = 0, the one whose first nonzero component is positive. No component is a negative zero
/// or, for rounding, beyond one. Rounded. Precondition: `is_rotation`, or nearly so.
std::array<double, 4> rotation_wxyz(const RigidTransform& X_AB);

/// The pose of a translation and a quaternion (w, x, y, z). The quaternion is normalized, so that
/// one with few digits gives a rotation; the zero quaternion does not turn. Rounded. Numbers are
/// taken as they are: those that are not finite are in the pose, too.
RigidTransform rigid_transform(const Eigen::Vector3d& translation,
                               const std::array<double, 4>& rotation_wxyz);

}  // namespace graspfit::geometry
