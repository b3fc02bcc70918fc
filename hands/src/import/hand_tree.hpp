#pragma once

#include <optional>
#include <string>

#include "description/robot_description.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// The kinematic tree of a description: links and joints parents first (depth first, children in
/// the order of the description), its couplings and exclusions. It has no surfaces, fingers or
/// pads.
///
/// The root link is `root` if given; what does not hang below it is left out. Else it is the
/// description's root, except that an arm before the hand is left out: as long as only one movable
/// joint hangs on the root (and the links fixed to it), the child of this joint becomes the root,
/// if joints branch further on. What is left out is noted. A coupling to a joint that is left out
/// is noted too; its follower becomes independent.
///
/// Faults, prefixed by `file`, are a cycle, two roots, no movable joint, and names of links or
/// joints that do not exist. Where faults are collected, the result is empty after a fault of the
/// tree itself, and couplings with a fault are left out.
/// @throws InvalidInput at the first fault where faults are thrown.
std::optional<HandModel> build_tree(const RobotDescription& description, const std::string& file,
                                    const std::optional<std::string>& root, Findings& findings);

}  // namespace graspfit::hands::internal
