#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "graspfit/hands/hand_model.hpp"

namespace graspfit::viewer {

/// Joint positions under a name, such as "half closed".
struct HandPose {
  std::string name;
  Eigen::VectorXd q;  ///< One position per joint of the hand [rad or m].
};

/// A hand by itself and the poses to show it in.
struct HandScene {
  hands::HandModel hand;
  std::string description;      ///< A sentence under the title; may be empty.
  std::vector<HandPose> poses;  ///< At least one; the page starts with the first.
  double clip_thickness = 0.0;  ///< Of clip volumes whose pad states none [m]; 0: not drawn.
};

/// What the page and the picture script (viewer/render_hand.py) know of the scene, as JSON: link
/// meshes, tree, joints and couplings, fingers, pads, palm, and each pose with its link poses in
/// the palm's frame H. Same input, same bytes.
/// @throws InvalidInput if there is no pose, a pose does not fit the hand, or the thickness is
/// negative or NaN.
std::string hand_scene_json(const HandScene& scene);

/// The page's text: one HTML document with everything in it, for any browser with WebGL 2, from
/// disk and without a network. Links are posed in the browser: a slider per independent joint,
/// couplings applied, a button per pose; joints as dots with their axes, palm center and direction
/// as an arrow, pads and clip volumes. Same input, same bytes. @throws as `hand_scene_json`.
std::string hand_page_html(const HandScene& scene);

/// Writes `hand_page_html` atomically. @throws IoError if that fails; InvalidInput as above.
void write_hand_page(const std::filesystem::path& file, const HandScene& scene);

}  // namespace graspfit::viewer
