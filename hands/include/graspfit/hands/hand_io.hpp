#pragma once

#include <filesystem>

#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// Reads a hand: a URDF and, beside it, the sidecar `<stem>.graspfit.json` (schema:
/// hands/models/hand_sidecar.schema.json) that says what a URDF cannot: fingers, thumb, pads, clip
/// volumes, palm frame, closing signs, couplings with breakaway, collision exclusions. Coupled
/// joints of the sidecar override `<mimic>` tags.
///
/// Link meshes are the URDF's collision geometry (visual geometry where a link has none): mesh
/// files relative to the URDF or `package://`, with scale; boxes, cylinders and spheres are
/// tessellated. Several geometries of one link are concatenated.
/// @throws IoError (file, what) for missing or malformed files and meshes.
/// @throws InvalidInput (file, item, value) for a description that makes no sense: cyclic tree, no
/// movable joint, NaN, duplicate names, zero axis, limits missing or reversed, unknown names in the
/// sidecar, pads without area.
HandModel read_hand_model(const std::filesystem::path& urdf_file);

}  // namespace graspfit::hands
