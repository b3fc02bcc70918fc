#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "graspfit/hands/hand_finding.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands {

/// A hand, and what its reader noticed and did.
struct HandReading {
  HandModel model;
  std::string description;            ///< A sentence for people, from the sidecar; may be empty.
  std::vector<HandFinding> findings;  ///< In the order in which they came up; no faults.
};

/// Reads a hand: a robot description and, if it is there, the sidecar `<stem>.graspfit.json` beside
/// it (schema: hands/models/hand_sidecar.schema.json) that says what descriptions cannot: fingers,
/// thumb, pads, clip volumes, palm frame, closing signs, couplings with breakaway, collision
/// exclusions. Members that the sidecar leaves out are derived from the tree and the meshes (see
/// hands/README.md for the rules) and noted. Couplings of the sidecar override the description's.
///
/// The root element tells the format of the description: URDF (`<robot>` with links), MJCF
/// (`<mujoco>`; needs a build with MuJoCo), GraspIt! robot XML (`<robot>` with `<palm>` and
/// `<chain>`s).
///
/// Link meshes are the collision geometry (visual geometry where a link has none). Paths of mesh
/// files are relative to the description or begin with `package://`; their scale is applied.
/// Primitives are tessellated, and several geometries of one link are concatenated. Open surfaces
/// are closed, which is noted.
/// @throws IoError (file, what) for missing or malformed files and meshes.
/// @throws InvalidInput (file, item, value) for a description that makes no sense: cyclic tree, no
/// movable joint, NaN, duplicate names, zero axis, limits missing or reversed, unknown names in the
/// sidecar, pads without area.
HandReading read_hand(const std::filesystem::path& description_file);

/// The model that `read_hand` reads. @throws as `read_hand`.
HandModel read_hand_model(const std::filesystem::path& description_file);

/// Path of the sidecar of a description: the description's path with the extension
/// `.graspfit.json`.
std::filesystem::path sidecar_file_of(const std::filesystem::path& description_file);

/// The text of a complete sidecar for a description. Members of the sidecar that is already beside
/// it are kept, the others are derived. @throws as `read_hand`.
std::string derived_sidecar_text(const std::filesystem::path& description_file);

/// SHA-256 of the bytes of every link's mesh files, one file after the other; empty for links
/// without any. Together with the hashes in the model it tells whether a hand is the one that was
/// recorded. @throws IoError if a file can no longer be read.
std::vector<std::string> link_mesh_hashes(const HandModel& hand);

}  // namespace graspfit::hands
