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
/// A joint is Rz(theta) Tz(d) Tx(a) Rx(alpha), where theta of a revolute joint, or d of a prismatic
/// one, is `dK*ratio+offset`. The joint position q is dK*ratio, without the offset, as in minValue
/// and maxValue; the offset is part of the joint's frame. At q = 0 the link's x axis therefore lies
/// along its common normal `a`. The frame of a link is at its own joint, as in a URDF; GraspIt!'s
/// frame is at the far end (at the next joint), and its meshes are moved accordingly. A link with
/// dynamicJointType Universal or Ball is attached by two or three joints, with links between them
/// that have no mesh.
///
/// Of several joints on one degree of freedom the first in the file leads, and the others follow by
/// the ratio of their ratios. The couplings have breakaway where the degree of freedom has type "b"
/// or a breakAwayTorque. The leader's limits are narrowed to what all of them allow, as GraspIt!
/// does; followers keep their own limits, for breakaway.
///
/// Joints are named `dK_chainI_jointJ`. Links are named by the stem of their body file, with
/// `chainI_` before it where it occurs more than once, and links between joints `<joint>_link`.
///
/// Meshes are the geometry of the body files (millimeters), where it exists and can be read. Links
/// without mesh get those of the only URDF beside the file, if its joints are in the same positions
/// (see `with_borrowed_meshes`). Both are noted. Masses of body files are not read.
/// @throws IoError, InvalidInput prefixed by the file, and the line where that helps.
RobotDescription parse_graspit(const std::string& text, const std::filesystem::path& file,
                               Findings& findings);

}  // namespace graspfit::hands::internal
