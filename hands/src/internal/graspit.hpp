#pragma once

#include <filesystem>
#include <string>

#include "internal/findings.hpp"
#include "internal/robot_description.hpp"

namespace graspfit::hands::internal {

/// Reads GraspIt! robot XML: palm, degrees of freedom and chains by Denavit-Hartenberg parameters,
/// in millimeters and degrees. Link meshes that are not there are taken from a URDF beside it whose
/// joints stand in the same places.
/// @throws IoError, InvalidInput prefixed by the file, and the line where that helps.
RobotDescription parse_graspit(const std::string& text, const std::filesystem::path& file,
                               Findings& findings);

}  // namespace graspfit::hands::internal
