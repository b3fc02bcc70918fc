#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/hands/hand_model.hpp"

namespace graspfit::viewer {

/// Named joint positions, such as "half closed".
struct HandPose {
  std::string name;
  Eigen::VectorXd q;  ///< One position per joint of the hand [rad or m].
};

/// A hand by itself and the poses to show it in.
struct HandScene {
  hands::HandModel hand;
  std::string description;      ///< A sentence under the title; may be empty.
  std::vector<HandPose> poses;  ///< At least one; the page starts with the first.
  /// Of clip volumes whose pad states none [m], > 0; empty: those are not drawn.
  std::optional<double> clip_thickness = {};
};

/// The data of the scene for the page and the picture script (viewer/render_hand.py), as JSON: link
/// meshes, tree, joints and couplings, fingers, pads, palm, and each pose with its link poses in
/// the palm's frame H. The same input gives the same bytes.
/// @throws InvalidInput if there is no pose, a pose does not fit the hand, or the thickness is
/// not finite and above 0.
std::string hand_scene_json(const HandScene& scene);

/// The page: one self-contained HTML document for any browser with WebGL 2, from disk and without a
/// network. Links are posed in the browser: there is a slider per independent joint, whose
/// followers move with it, and a button per pose. The page shows joints as dots with their axes,
/// palm center and direction as an arrow, pads and clip volumes. The same input gives the same
/// bytes. @throws as `hand_scene_json`.
std::string hand_page_html(const HandScene& scene);

/// Writes `hand_page_html` atomically. @throws IoError if that fails; InvalidInput as
/// `hand_scene_json`.
void write_hand_page(const std::filesystem::path& file, const HandScene& scene);

}  // namespace graspfit::viewer
