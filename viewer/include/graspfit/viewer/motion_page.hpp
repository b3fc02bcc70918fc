#pragma once

#include <filesystem>
#include <string>

#include "graspfit/motion/motion_io.hpp"
#include "graspfit/motion/table_motion.hpp"

namespace graspfit::viewer {

/// What is known of a motion's collisions when it is shown.
enum class MotionCheck {
  NotChecked,
  Free,     ///< Every segment was proven free of collisions.
  NotFree,  ///< At least one segment collides, or was not proven free.
};

/// A motion to show, in which a hand moves objects on a table. Poses are in the world W, in meters.
struct MotionInput {
  motion::TableScene scene;     ///< Hand and objects that `file` names.
  motion::MotionFile file;      ///< With at least one move.
  double frame_step = 0.01;     ///< No point moves farther between two frames [m], > 0.
  double largest_speed = 0.25;  ///< Largest speed of any point at the page's normal pace [m/s],
                                ///< > 0: motions have no times of their own.
  MotionCheck check = MotionCheck::NotChecked;  ///< The page shows it.
};

/// The data of a motion for the page and the picture script (viewer/render_motion.py), as JSON:
/// meshes, and in every frame the poses of all objects and links; moves and phases with their first
/// and last frames. The same input gives the same bytes.
/// @throws InvalidInput if there is no move, scene and file differ in their objects or joints, a
/// step or speed is not positive, or a segment is so long that it would take more than 100 000
/// frames.
std::string motion_scene_json(const MotionInput& input);

/// The page: one self-contained HTML document for any browser with WebGL 2, from disk and without a
/// network. It has play and pause, a slider over time, and a choice of the move. It takes about 0.5
/// MB per thousand frames beside the meshes. The same input gives the same bytes. @throws as
/// `motion_scene_json`.
std::string motion_page_html(const MotionInput& input);

/// Writes `motion_page_html` atomically. @throws IoError if that fails; InvalidInput as
/// `motion_scene_json`.
void write_motion_page(const std::filesystem::path& file, const MotionInput& input);

}  // namespace graspfit::viewer
