#pragma once

#include <filesystem>

namespace graspfit::app {

/// Throws IoError if the picture script is not there.
void require_pictures();

/// Draws grasp_NNN.png of every grasp of `folder`/grasps.json into `folder`, with VTK by the script
/// that comes with the viewer. @throws IoError if the script fails; its own words go to standard
/// error.
void draw_pictures(const std::filesystem::path& folder);

}  // namespace graspfit::app
