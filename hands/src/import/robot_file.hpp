#pragma once

#include <filesystem>
#include <string>

#include "description/robot_description.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// Parses a robot description of any known format, told by its root element. `text` is the file's.
/// @throws IoError prefixed by the file where it is none of them; as the format's reader.
RobotDescription parse_robot_file(const std::string& text, const std::filesystem::path& file,
                                  Findings& findings);

}  // namespace graspfit::hands::internal
