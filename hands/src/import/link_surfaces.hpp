#pragma once

#include <filesystem>

#include "description/robot_description.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// Sets `link`'s closed surface and mesh files: collision geometry, or visual geometry where the
/// link has none; several parts are concatenated, equal ones taken once.
///
/// A part that is open, not manifold or inside out is mended by `geometry::repair_mesh`, holes of
/// any size filled. Where that fails, each of its connected pieces is mended by itself, and a piece
/// that still cannot be closed or has no volume (a flat sheet) is wrapped at 0.005 of its longest
/// extent [CGAL Alpha_wrap_3]. `findings` gets one note per link: boundary edges, parts inside out,
/// what was done, and how far the new surface is from the old one at most (the middle of a filled
/// hole counts).
/// @throws IoError, InvalidInput (file, link, mesh) for a mesh that is not there, lies outside the
/// description's package, or cannot be closed.
void read_link_surface(const DescribedLink& source, const std::filesystem::path& description_file,
                       Link& link, Findings& findings);

}  // namespace graspfit::hands::internal
