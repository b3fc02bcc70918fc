#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/mesh_io.hpp"

namespace graspfit::geometry::internal {

/// What a mesh file holds: points and polygons of three or more corners, indices checked.
struct PolygonSoup {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::int32_t> corners;       ///< Of all polygons, one after the other.
  std::vector<std::size_t> polygon_begin;  ///< First corner of each polygon.

  std::size_t num_polygons() const { return polygon_begin.size(); }

  /// Corners of a polygon.
  std::span<const std::int32_t> polygon(std::size_t i) const {
    const std::size_t end = i + 1 < num_polygons() ? polygon_begin[i + 1] : corners.size();
    return {corners.data() + polygon_begin[i], corners.data() + end};
  }

  /// @throws IoError if the point is not finite.
  void add_vertex(const Eigen::Vector3d& point) {
    if (!point.allFinite()) {
      throw base::IoError("vertex " + std::to_string(vertices.size()) +
                          " has a coordinate that is not finite");
    }
    vertices.push_back(point);
  }
};

/// Message about a face that uses a vertex that is not one of the `count` existing ones.
inline std::string out_of_range(std::size_t face, std::int64_t vertex, std::size_t count) {
  return "face " + std::to_string(face) + " uses vertex " + std::to_string(vertex) + " of " +
         std::to_string(count);
}

/// Readers of one format each. They throw IoError with a text that lacks only the file's name.
///
/// OFF, OBJ, PLY and STL are read here and not by assimp, which keeps coordinates in single
/// precision and lets some broken files through.
PolygonSoup parse_off(std::string_view content);
PolygonSoup parse_obj(std::string_view content);
PolygonSoup parse_ply(std::string_view content);
PolygonSoup parse_stl(std::string_view content);

/// glTF and GLB, by assimp, as the format has single precision anyway. assimp reads only what
/// `checked_glb` has checked and written; buffers in other files are searched for in `folder`.
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
