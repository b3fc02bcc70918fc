#pragma once

#include <filesystem>

namespace graspfit::app {

/// Throws IoError if the picture script or what it needs is not there; asked before work starts.
void require_pictures();

/// Draws grasp_NNN.png of every grasp of `folder`/grasps.json into `folder`, with VTK by the script
/// that comes with the viewer. @throws IoError with the script's own words if it fails.
void draw_pictures(const std::filesystem::path& folder);

}  // namespace graspfit::app
