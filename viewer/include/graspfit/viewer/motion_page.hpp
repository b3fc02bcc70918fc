#pragma once

#include <filesystem>
#include <string>

#include "graspfit/motion/motion_io.hpp"
#include "graspfit/motion/table_motion.hpp"

namespace graspfit::viewer {

/// What is known of a motion when it is shown.
enum class MotionCheck {
  NotChecked,
  Free,     ///< Every segment was proven free of collisions.
  NotFree,  ///< At least one is not, or could not be proven so.
};

/// A hand that moves objects about on a table, to be looked at. In the world W, in meters.
struct MotionInput {
  motion::TableScene scene;     ///< Of the file: hand and objects as it names them.
  motion::MotionFile file;      ///< With at least one move.
  double frame_step = 0.01;     ///< No point moves farther between two frames [m], > 0.
  double largest_speed = 0.25;  ///< Of the fastest point, as it is shown [m/s], > 0: motions have
                                ///< no times of their own.
  MotionCheck check = MotionCheck::NotChecked;  ///< The page says so.
};

/// What the page and the picture script (viewer/render_motion.py) know of a motion, as JSON:
/// meshes, and in every frame the poses of all objects and links; moves and phases with their first
/// and last frames. Same input, same bytes.
/// @throws InvalidInput if there is no move, scene and file differ in their objects or joints, a
/// step or speed is not positive, or a segment is so long that it would take more than 100 000
/// frames.
std::string motion_scene_json(const MotionInput& input);

/// The page's text: one HTML document with everything in it, for any browser with WebGL 2, from
/// disk and without a network: play and pause, a slider over time, a choice of the move. About 0.5
/// MB per thousand frames beside the meshes. Same input, same bytes. @throws as
/// `motion_scene_json`.
std::string motion_page_html(const MotionInput& input);

/// Writes `motion_page_html` atomically. @throws IoError if that fails; InvalidInput as above.
void write_motion_page(const std::filesystem::path& file, const MotionInput& input);

}  // namespace graspfit::viewer
