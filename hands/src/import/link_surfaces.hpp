#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "description/robot_description.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"
#include "model/findings.hpp"

namespace graspfit::hands::internal {

/// What a link's geometry is made into.
struct LinkSurface {
  geometry::TriangleMesh mesh_L;        ///< Closed.
  std::vector<std::string> mesh_files;  ///< Read for it, as `Link::mesh_files`.
};

/// Reads a link's closed surface: collision geometry, or visual geometry where the link has none;
/// several parts are concatenated, equal ones taken once.
///
/// A part that is open, not manifold or inside out is mended by `geometry::repair_mesh`, holes of
/// any size filled. Where that fails, each of its connected pieces is mended by itself, and a piece
/// that still cannot be closed or has no volume (a flat sheet) is wrapped at 0.005 of its longest
/// extent [CGAL Alpha_wrap_3]. `findings` gets one note per link: boundary edges, parts inside out,
/// what was done, and how far the new surface is from the old one at most (the middle of a filled
/// hole counts).
/// @throws IoError, InvalidInput (file, link, mesh) for a mesh that is not there, lies outside the
/// description's package, or cannot be closed.
LinkSurface read_link_surface(const DescribedLink& source,
                              const std::filesystem::path& description_file, Findings& findings);

}  // namespace graspfit::hands::internal
