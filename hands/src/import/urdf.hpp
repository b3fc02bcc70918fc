#pragma once

#include <string>

#include "description/robot_description.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// Parses the text of a URDF. Numbers are read in the C locale whatever the program's locale is.
/// Faults and what looks wrong go to `findings`, with the line.
/// @throws IoError prefixed by `file` where the text is no URDF at all.
RobotDescription parse_urdf(const std::string& text, const std::string& file, Findings& findings);

}  // namespace graspfit::hands::internal
