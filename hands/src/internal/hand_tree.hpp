#pragma once

#include <string>

#include "graspfit/hands/hand_model.hpp"
#include "internal/robot_description.hpp"

namespace graspfit::hands::internal {

/// The kinematic tree of a description: links and joints parents first (depth first, children in
/// the order of the description), its couplings and exclusions. Without surfaces, fingers, pads.
/// @throws InvalidInput, prefixed by `file`, for a cycle, two roots, no movable joint, names that
/// nothing bears.
HandModel build_tree(const RobotDescription& description, const std::string& file);

}  // namespace graspfit::hands::internal
