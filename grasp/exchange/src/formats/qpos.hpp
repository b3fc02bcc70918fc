#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "graspfit/grasp/object_file.hpp"
#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::exchange::internal {

/// Appends position, quaternion w, x, y, z and joints; NaN where there is no configuration.
void append_qpos(const hands::HandConfiguration* configuration, std::size_t num_joints,
                 std::vector<double>& values);

/// Position and quaternion w, x, y, z of O in the world of an object that was laid down; of any
/// other O is the world.
std::array<double, 7> object_pose(const grasp::ObjectRecord& object);

}  // namespace graspfit::exchange::internal
