#pragma once

#include <Eigen/Core>

#include "graspfit/base/json_value.hpp"
#include "graspfit/geometry/rigid_transform.hpp"

namespace graspfit::grasp::internal {

/// Poses in JSON state their rotation as this function gives it.
using geometry::rotation_wxyz;

/// The vector and the pose of a JSON value: [x, y, z], and {translation_m, rotation_wxyz}.
Eigen::Vector3d vector3(const base::JsonValue& value);
geometry::RigidTransform pose(const base::JsonValue& value);

}  // namespace graspfit::grasp::internal
