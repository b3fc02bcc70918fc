#pragma once

#include <filesystem>
#include <string>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// How the numbers of a mesh file become meters.
struct MeshReadOptions {
  double meters_per_file_unit = 1.0;  ///< > 0 and finite. Mesh files rarely say their unit.
  void validate() const;              ///< Throws InvalidInput naming the field and its value.
};

/// What a mesh file held and what reading did to it.
struct MeshFileReport {
  std::string format;                 ///< Lower-case extension that chose the reader, e.g. "off".
  std::size_t num_file_vertices = 0;  ///< Vertices as stored (after the importer's own expansion).
  std::size_t num_file_polygons = 0;  ///< Polygons as stored, triangles included.
  std::size_t num_polygons_triangulated = 0;  ///< Polygons with more than three corners.
  std::size_t num_vertices_welded = 0;  ///< Vertices dropped since another has the same position.
};

/// A mesh read from a file, welded and triangulated but not repaired.
struct MeshFile {
  TriangleMesh mesh;
  MeshFileReport report;
};

/// Reads a surface mesh: OFF, OBJ, PLY, STL (ASCII or binary), glTF and GLB, chosen by the file's
/// extension; all parts of a scene in its root frame.
///
/// Vertices with identical coordinates are welded (STL stores three per triangle, OBJ repeats
/// them along texture seams; first occurrence keeps its index order) and polygons triangulated.
/// Nothing else is changed: faces that become degenerate stay and `analyze` counts them.
/// @throws IoError with file, what is wrong and the value: missing, unreadable, empty or truncated
/// file, unknown extension, text that is not a mesh, NaN or infinite coordinate, face index out of
/// range, no faces (a point cloud says so).
/// @throws InvalidInput for bad options.
MeshFile read_mesh(const std::filesystem::path& file, const MeshReadOptions& options = {});

/// Writes OFF, OBJ, PLY (binary little-endian doubles) or STL (binary), chosen by the extension,
/// coordinates in meters (text: shortest round-trip numbers). Atomic: see `write_file_atomically`.
/// @throws IoError if the file cannot be written or the extension is unknown.
void write_mesh(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace graspfit::geometry
