#pragma once

#include <optional>

#include "graspfit/hands/hand_model.hpp"
#include "page_json.hpp"

namespace graspfit::viewer::internal {

// Data of a hand for both pages and the picture: link meshes, the tree with its joints and
// couplings, fingers, pads with their clip volumes, palm. `clip_thickness` is for pads that give
// none [m]; empty: the clip volumes of these pads are left out.
Json hand_data(const hands::HandModel& hand, const std::optional<double>& clip_thickness);

// Corners, triangles and edges of a pad's clip volume, in the pad's frame; edges are where faces
// meet at 20 degrees or more.
Json clip_volume(const hands::ContactPad& pad, double thickness);

}  // namespace graspfit::viewer::internal
