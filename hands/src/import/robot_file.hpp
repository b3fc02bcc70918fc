#pragma once

#include <filesystem>
#include <string>

#include "description/robot_description.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// Parses a robot description of any known format, which its root element tells. `text` is the
/// content of `file`.
/// @throws IoError prefixed by the file where the format is not known; as the format's reader.
RobotDescription parse_robot_file(const std::string& text, const std::filesystem::path& file,
                                  Findings& findings);

}  // namespace graspfit::hands::internal
