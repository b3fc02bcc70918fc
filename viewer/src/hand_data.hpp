#pragma once

#include "graspfit/hands/hand_model.hpp"
#include "page_json.hpp"

namespace graspfit::viewer::internal {

// What both pages and the picture of a hand know of it: link meshes, the tree with its joints and
// couplings, fingers, pads with their clip volumes, palm. `clip_thickness` is for pads that state
// none [m]; 0: theirs are left out.
Json hand_data(const hands::HandModel& hand, double clip_thickness);

// Corners, triangles and edges of a pad's clip volume, in the pad's frame; edges where faces meet
// at 20 degrees or more.
Json clip_volume(const hands::ContactPad& pad, double thickness);

}  // namespace graspfit::viewer::internal
