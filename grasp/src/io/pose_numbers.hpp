#pragma once

#include <Eigen/Core>
#include <array>

#include "graspfit/base/json_value.hpp"
#include "graspfit/geometry/rigid_transform.hpp"

namespace graspfit::grasp::internal {

/// The rotation of a pose as a unit quaternion (w, x, y, z) with w ≥ 0 (of the two with w = 0, the
/// one whose first nonzero component is positive).
std::array<double, 4> rotation_wxyz(const geometry::RigidTransform& X_AB);

/// The pose of these numbers; the quaternion is normalized.
geometry::RigidTransform pose(const Eigen::Vector3d& translation,
                              const std::array<double, 4>& rotation_wxyz);

/// The vector and the pose of a JSON value: [x, y, z], and {translation_m, rotation_wxyz}.
Eigen::Vector3d vector3(const base::JsonValue& value);
geometry::RigidTransform pose(const base::JsonValue& value);

}  // namespace graspfit::grasp::internal
