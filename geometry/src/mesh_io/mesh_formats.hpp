#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "graspfit/geometry/mesh_io.hpp"

namespace graspfit::geometry::internal {

/// What a mesh file holds: points and polygons of three or more corners, indices checked.
struct PolygonSoup {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::int32_t> corners;       ///< Of all polygons, one after the other.
  std::vector<std::size_t> polygon_begin;  ///< First corner of each polygon.

  std::size_t num_polygons() const { return polygon_begin.size(); }
};

/// Readers of one format each. They throw IoError with a text that lacks only the file's name.
///
/// OFF, OBJ, PLY and STL are read here and not by assimp, which keeps coordinates in single
/// precision and lets some broken files through.
PolygonSoup parse_off(std::string_view content);
PolygonSoup parse_obj(std::string_view content);
PolygonSoup parse_ply(std::string_view content);
PolygonSoup parse_stl(std::string_view content);

/// glTF and GLB, by assimp, as the format has single precision anyway. What assimp sees is checked
/// and made by `checked_glb`; buffers in other files are those in `folder`.
PolygonSoup import_gltf(std::string_view content, const std::filesystem::path& folder);

/// `read_mesh` of a file's bytes: `format` is "off", "obj", "ply" or "stl". Throws like the
/// readers.
MeshFile mesh_from_content(std::string_view content, const std::string& format,
                           double meters_per_file_unit = 1.0);

std::string format_off(const TriangleMesh& mesh);
std::string format_obj(const TriangleMesh& mesh);
std::string format_ply(const TriangleMesh& mesh);
std::string format_stl(const TriangleMesh& mesh);

}  // namespace graspfit::geometry::internal
