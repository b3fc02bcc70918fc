#pragma once

#include <filesystem>
#include <string>

#include "internal/findings.hpp"
#include "internal/robot_description.hpp"

namespace graspfit::hands::internal {

/// Reads MJCF through the MuJoCo library, which resolves includes, defaults, angle units and mesh
/// files; `file` is where it lies. Poses are MuJoCo's doubles, mesh vertices its single precision
/// (relative 6e-8), which `findings` notes.
/// @throws IoError (file, MuJoCo's own words) where MuJoCo refuses it, or in a build without
/// MuJoCo.
/// @throws InvalidInput (file, item) for what a hand cannot have: ball joints, free bodies inside.
RobotDescription parse_mjcf(const std::string& text, const std::filesystem::path& file,
                            Findings& findings);

}  // namespace graspfit::hands::internal
