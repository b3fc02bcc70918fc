#pragma once

#include <mujoco/mujoco.h>

#include <optional>
#include <vector>

#include "description/robot_description.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// Sets the couplings of the joints of `description`, from <equality> constraints and from tendons
/// driven by actuators. `link_of[b]` and `joint_of[j]` are the indices in the description of
/// MuJoCo's body b and joint j, empty if they are left out. Constraints that cannot be kept are
/// reported in `findings`.
///
/// - <equality><joint>: q1 = ref1 + p(q2 − ref2); a polynomial of higher degree becomes the
///   straight line that is nearest in the least squares over the leader's limits. Without joint2,
///   or with a constant polynomial, the joint becomes a fixed joint at that position.
/// - <equality><tendon> of fixed tendons: the same, if the constraint involves one or two joints.
/// - A fixed tendon with an actuator: its joints that have no actuator of their own and follow no
///   other joint go through their ranges together, led by the first in the tree, and break away:
///   such a tendon lets one joint go on when another is blocked.
/// - Inactive constraints are left out, <connect> and <weld> too.
void read_mjcf_couplings(const mjModel& model, const std::vector<std::optional<int>>& link_of,
                         const std::vector<std::optional<int>>& joint_of,
                         RobotDescription& description, Findings& findings);

}  // namespace graspfit::hands::internal
