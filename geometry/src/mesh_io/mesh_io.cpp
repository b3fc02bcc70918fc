#include "graspfit/geometry/mesh_io.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "mesh/vertex_welding.hpp"
#include "mesh_io/mesh_formats.hpp"

namespace graspfit::geometry {
namespace {

using internal::PolygonSoup;

std::string lower_case_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

std::string unknown_extension(const std::string& extension, const char* known) {
  return (extension.empty() ? "the file name has no extension"
                            : "unknown extension '." + extension + "'") +
         "; known are " + known;
}

PolygonSoup parse(std::string_view content, const std::string& format) {
  if (format == "off") return internal::parse_off(content);
  if (format == "obj") return internal::parse_obj(content);
  if (format == "ply") return internal::parse_ply(content);
  return internal::parse_stl(content);
}

// Cuts a polygon into triangles: from its first corner if it is convex, else by cutting off ears,
// in the coordinate plane where its projection has the largest area.
void triangulate(const std::vector<Eigen::Vector3d>& vertices,
                 std::span<const std::int32_t> polygon, std::vector<Face>& faces) {
  if (polygon.size() == 3) {
    faces.push_back({polygon[0], polygon[1], polygon[2]});
    return;
  }
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const Eigen::Vector3d& a = vertices[polygon[0]];
    normal += (vertices[polygon[i - 1]] - a).cross(vertices[polygon[i]] - a);
  }
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const double orientation = normal[axis] < 0.0 ? -1.0 : 1.0;
  const auto area = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
    const Eigen::Vector3d ab = vertices[b] - vertices[a];
    const Eigen::Vector3d ac = vertices[c] - vertices[a];
    return orientation * (ab[u] * ac[v] - ab[v] * ac[u]);
  };

  std::vector<std::int32_t> rest(polygon.begin(), polygon.end());
  const auto is_ear = [&](std::size_t i) {
    const std::size_t n = rest.size();
    const std::int32_t a = rest[(i + n - 1) % n];
    const std::int32_t b = rest[i];
    const std::int32_t c = rest[(i + 1) % n];
    if (!(area(a, b, c) > 0.0)) return false;
    return std::none_of(rest.begin(), rest.end(), [&](std::int32_t p) {
      return p != a && p != b && p != c && area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 &&
             area(c, a, p) >= 0.0;
    });
  };
  bool is_convex = true;
  for (std::size_t i = 0; i < rest.size() && is_convex; ++i) {
    const std::size_t n = rest.size();
    is_convex = area(rest[(i + n - 1) % n], rest[i], rest[(i + 1) % n]) > 0.0;
  }
  while (rest.size() > 3 && !is_convex) {
    std::size_t ear = 1;
    while (ear < rest.size() && !is_ear(ear)) ++ear;
    if (ear == rest.size()) break;  // Not a simple polygon: whatever triangles, the edges match.
    const std::size_t n = rest.size();
    faces.push_back({rest[ear - 1], rest[ear], rest[(ear + 1) % n]});
    rest.erase(rest.begin() + ear);
  }
  for (std::size_t i = 2; i < rest.size(); ++i) faces.push_back({rest[0], rest[i - 1], rest[i]});
}

MeshFile mesh_of(PolygonSoup soup, const std::string& format, double meters_per_file_unit) {
  if (soup.num_polygons() == 0) {
    throw base::IoError(soup.vertices.empty()
                            ? std::string("no vertices and no faces")
                            : "no faces: a point cloud of " + std::to_string(soup.vertices.size()) +
                                  " points");
  }
  if (soup.vertices.size() > std::numeric_limits<std::int32_t>::max() / 2) {
    throw base::IoError("too many vertices");
  }
  MeshFile result;
  MeshFileReport& report = result.report;
  report.format = format;
  report.num_file_vertices = soup.vertices.size();
  report.num_file_polygons = soup.num_polygons();
  for (std::size_t i = 0; i < soup.vertices.size(); ++i) {
    soup.vertices[i] *= meters_per_file_unit;
    if (!soup.vertices[i].allFinite()) {
      throw base::IoError("vertex " + std::to_string(i) + " is not finite in meters");
    }
  }
  const std::vector<std::int32_t> target = internal::weld_equal(soup.vertices);
  report.num_vertices_welded = target.size() - soup.vertices.size();
  for (std::int32_t& corner : soup.corners) corner = target[corner];
  result.mesh.vertices = std::move(soup.vertices);
  result.mesh.faces.reserve(soup.corners.size() - 2 * soup.num_polygons());
  for (std::size_t i = 0; i < soup.num_polygons(); ++i) {
    const std::span<const std::int32_t> polygon = soup.polygon(i);
    if (polygon.size() > 3) ++report.num_polygons_triangulated;
    triangulate(result.mesh.vertices, polygon, result.mesh.faces);
  }
  return result;
}

}  // namespace

namespace internal {

MeshFile mesh_from_content(std::string_view content, const std::string& format,
                           double meters_per_file_unit) {
  return mesh_of(parse(content, format), format, meters_per_file_unit);
}

}  // namespace internal

void MeshReadOptions::validate() const {
  if (!(meters_per_file_unit > 0.0) || !std::isfinite(meters_per_file_unit)) {
    throw base::InvalidInput("meters_per_file_unit is " +
                             base::shortest_decimal(meters_per_file_unit) + ", must be positive");
  }
}

MeshFile read_mesh(const std::filesystem::path& file, const MeshReadOptions& options) {
  options.validate();
  const std::string prefix = "read_mesh: " + file.string() + ": ";
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw base::IoError(prefix + "no such file");
  if (std::filesystem::is_directory(status)) throw base::IoError(prefix + "it is a folder");

  const std::string format = lower_case_extension(file);
  constexpr std::array<std::string_view, 6> kFormats = {"off", "obj", "ply", "stl", "gltf", "glb"};
  if (std::find(kFormats.begin(), kFormats.end(), format) == kFormats.end()) {
    throw base::IoError(prefix + unknown_extension(format, "off, obj, ply, stl, gltf, glb") +
                        "; Blender, MeshLab or 'assimp export FILE NEW.obj' convert most others");
  }
  try {
    const std::string content = base::read_file(file);
    if (content.empty()) throw base::IoError("the file is empty");
    if (format == "gltf" || format == "glb") {
      return mesh_of(internal::import_gltf(content, file.parent_path()), format,
                     options.meters_per_file_unit);
    }
    return internal::mesh_from_content(content, format, options.meters_per_file_unit);
  } catch (const base::IoError& failure) {
    const std::string_view what = failure.what();
    throw base::IoError(what.starts_with("cannot read ") ? "read_mesh: " + std::string(what)
                                                         : prefix + std::string(what));
  }
}

void write_mesh(const std::filesystem::path& file, const TriangleMesh& mesh) {
  const std::string format = lower_case_extension(file);
  if (format == "off") {
    base::write_file_atomically(file, internal::format_off(mesh));
  } else if (format == "obj") {
    base::write_file_atomically(file, internal::format_obj(mesh));
  } else if (format == "ply") {
    base::write_file_atomically(file, internal::format_ply(mesh));
  } else if (format == "stl") {
    base::write_file_atomically(file, internal::format_stl(mesh));
  } else {
    throw base::IoError("write_mesh: " + file.string() + ": " +
                        unknown_extension(format, "off, obj, ply, stl"));
  }
}

}  // namespace graspfit::geometry
