#pragma once

#include <filesystem>
#include <string>

#include "description/robot_description.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// Reads GraspIt! robot XML: palm, degrees of freedom and chains by Denavit-Hartenberg parameters,
/// in millimeters and degrees
/// (https://graspit-simulator.github.io/build/html/data_files_robots.html).
///
/// A joint is Rz(theta) Tz(d) Tx(a) Rx(alpha), one of them `dK*ratio+offset`: theta of a revolute,
/// d of a prismatic joint. Its position q is dK*ratio, without the offset, as minValue and maxValue
/// mean it; the offset stands in the joint's frame. So at q = 0 the link's x axis lies along its
/// common normal `a`. Link frames stand at their own joint, as in a URDF; GraspIt!'s stand at the
/// far end (at the next joint), and its meshes are moved accordingly. A link with dynamicJointType
/// Universal or Ball hangs on two or three joints with links between them that have no mesh.
///
/// Of several joints on one degree of freedom the first in the file leads, the others follow by the
/// ratio of their ratios; breakaway where the degree of freedom has type "b" or a breakAwayTorque.
/// The leader's limits are narrowed to what all of them allow, as GraspIt! does; followers keep
/// their own, for breakaway.
///
/// Names: joints `dK_chainI_jointJ`; links by the stem of their body file, with `chainI_` before it
/// where it occurs more than once; links between joints `<joint>_link`.
///
/// Meshes: the body files' geometry where it is there and can be read (millimeters). Links without
/// are given those of the only URDF beside it, if its joints stand in the same places, see
/// `borrow_meshes`; both is noted. Masses of body files are not read.
/// @throws IoError, InvalidInput prefixed by the file, and the line where that helps.
RobotDescription parse_graspit(const std::string& text, const std::filesystem::path& file,
                               Findings& findings);

}  // namespace graspfit::hands::internal
