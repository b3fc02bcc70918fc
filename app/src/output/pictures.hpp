#pragma once

#include <filesystem>
#include <string>

namespace graspfit::app {

/// Throws IoError if the picture scripts or the packages that they need are missing; it is called
/// before work starts. `flag` is the flag that requested pictures: messages start with it.
void require_pictures(const std::string& flag);

/// Draws grasp_NNN.png of every grasp of `folder`/grasps.json into `folder`, with VTK by the script
/// that comes with the viewer. `note` is a line in each picture; empty: none.
/// @throws IoError with the script's own words if it fails.
void draw_pictures(const std::filesystem::path& folder, const std::string& note);

/// Draws a hand's poses into the file `picture` from a scene of viewer::hand_scene_json. No file is
/// left behind if this fails. @throws IoError with the script's own words if it fails.
void draw_hand_picture(const std::string& scene_json, const std::filesystem::path& picture);

/// Throws IoError if the package that animated pictures need besides (python3-pil) is missing.
void require_animations(const std::string& flag);

/// Draws a hold test into the file `picture`, an animated GIF, from a scene of
/// viewer::replay_scene_json. @throws IoError with the script's own words if it fails.
void draw_replay_picture(const std::string& scene_json, const std::filesystem::path& picture);

/// Draws a hand that moves objects about into the file `picture`, from a scene of
/// viewer::motion_scene_json: an animated GIF, or a PNG with a picture per phase. `flag` is the
/// flag that requested it. @throws IoError with the script's own words if it fails.
void draw_motion_picture(const std::string& flag, const std::string& scene_json,
                         const std::filesystem::path& picture);

}  // namespace graspfit::app
