#pragma once

#include <filesystem>

#include "graspfit/hands/hand_model.hpp"
#include "internal/findings.hpp"
#include "internal/robot_description.hpp"

namespace graspfit::hands::internal {

/// Sets `link`'s closed surface and mesh files: collision geometry, or visual geometry where the
/// link has none; several parts are concatenated. A surface that is open or inside out is closed
/// by `geometry::repair_mesh`, and `findings` gets a note of what was done and how far it moved.
/// @throws IoError, InvalidInput (file, link, mesh) for a mesh that is not there, lies outside the
/// description's package, or cannot be closed.
void read_link_surface(const DescribedLink& source, const std::filesystem::path& description_file,
                       Link& link, Findings& findings);

}  // namespace graspfit::hands::internal
