#include "graspfit/geometry/shapes.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "shapes/shape_limits.hpp"
#include "shapes/turned_surface.hpp"

namespace graspfit::geometry {
namespace {

using internal::kMostSegments;
using internal::require_positive;
using internal::require_range;
using internal::turn;

}  // namespace

TriangleMesh ball(double radius, int subdivisions) {
  require_positive("ball", "radius", radius);
  require_range("ball", "subdivisions", subdivisions, 0, 8);
  const double g = std::numbers::phi;
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.faces = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex.normalize();
  for (int level = 0; level < subdivisions; ++level) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> midpoints;
    const auto midpoint = [&](std::int32_t a, std::int32_t b) {
      const auto [entry, is_new] = midpoints.try_emplace(std::minmax(a, b), 0);
      if (is_new) {
        entry->second = base::as_index<std::int32_t>(mesh.vertices.size());
        mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
      }
      return entry->second;
    };
    std::vector<Face> faces;
    faces.reserve(4 * mesh.faces.size());
    for (const auto& [a, b, c] : mesh.faces) {
      const std::int32_t ab = midpoint(a, b);
      const std::int32_t bc = midpoint(b, c);
      const std::int32_t ca = midpoint(c, a);
      faces.insert(faces.end(), {Face{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.faces = std::move(faces);
  }
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex *= radius;
  return mesh;
}

TriangleMesh box(const Eigen::Vector3d& size) {
  for (int axis = 0; axis < 3; ++axis) require_positive("box", "size", size[axis]);
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    mesh.vertices.emplace_back((corner & 1 ? 0.5 : -0.5) * size[0],
                               (corner & 2 ? 0.5 : -0.5) * size[1],
                               (corner & 4 ? 0.5 : -0.5) * size[2]);
  }
  mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh torus(double major_radius, double minor_radius, int major_segments,
                   int minor_segments) {
  require_positive("torus", "minor_radius", minor_radius);
  require_positive("torus", "major_radius", major_radius);
  if (major_radius <= minor_radius) {
    throw base::InvalidInput("torus: major_radius is " + base::shortest_decimal(major_radius) +
                             ", must exceed minor_radius " + base::shortest_decimal(minor_radius));
  }
  require_range("torus", "major_segments", major_segments, 3, kMostSegments);
  require_range("torus", "minor_segments", minor_segments, 3, kMostSegments);
  TriangleMesh mesh;
  for (int i = 0; i < major_segments; ++i) {
    const auto [cos_i, sin_i] = turn(i, major_segments);
    for (int j = 0; j < minor_segments; ++j) {
      const auto [cos_j, sin_j] = turn(j, minor_segments);
      const double r = major_radius + minor_radius * cos_j;
      mesh.vertices.emplace_back(r * cos_i, r * sin_i, minor_radius * sin_j);
    }
  }
  const auto at = [&](int i, int j) {
    return (i % major_segments) * minor_segments + j % minor_segments;
  };
  for (int i = 0; i < major_segments; ++i) {
    for (int j = 0; j < minor_segments; ++j) {
      mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

TriangleMesh cylinder(double radius, double height, int segments) {
  require_positive("cylinder", "radius", radius);
  require_positive("cylinder", "height", height);
  require_range("cylinder", "segments", segments, 3, kMostSegments);
  return solid_of_revolution(
      {{0.0, -height / 2}, {radius, -height / 2}, {radius, height / 2}, {0.0, height / 2}},
      segments);
}

TriangleMesh capsule(double radius, double height, int segments) {
  require_positive("capsule", "radius", radius);
  require_positive("capsule", "height", height);
  require_range("capsule", "segments", segments, 4, kMostSegments);
  // Half as many steps along a meridian as around: nearly square cells.
  const int steps = segments / 4;
  std::vector<Eigen::Vector2d> profile;
  for (int i = 0; i <= steps; ++i) {
    const auto [c, s] = turn(i, 4 * steps);
    profile.emplace_back(radius * s, -height / 2 - radius * c);
  }
  for (int i = steps; i >= 0; --i) {
    const auto [c, s] = turn(i, 4 * steps);
    profile.emplace_back(radius * s, height / 2 + radius * c);
  }
  return solid_of_revolution(profile, segments);
}

TriangleMesh solid_of_revolution(const std::vector<Eigen::Vector2d>& profile, int segments) {
  const char* const name = "solid_of_revolution";
  require_range(name, "segments", segments, 3, kMostSegments);
  if (profile.size() < 3) {
    throw base::InvalidInput("solid_of_revolution: the profile has " +
                             std::to_string(profile.size()) + " points, needs at least 3");
  }
  if (profile.front()[0] != 0.0 || profile.back()[0] != 0.0) {
    throw base::InvalidInput("solid_of_revolution: the profile must start and end on the axis");
  }
  for (std::size_t i = 0; i < profile.size(); ++i) {
    if (!profile[i].allFinite()) {
      throw base::InvalidInput("solid_of_revolution: profile point " + std::to_string(i) +
                               " is not finite");
    }
    if (i > 0 && i + 1 < profile.size()) require_positive(name, "profile radius", profile[i][0]);
  }

  // Rings of `segments` vertices between the two poles; z ascending winds the faces outward.
  TriangleMesh mesh;
  const auto rings = base::as_index<std::int32_t>(profile.size()) - 2;
  mesh.vertices.emplace_back(0.0, 0.0, profile.front()[1]);
  for (std::int32_t ring = 0; ring < rings; ++ring) {
    const Eigen::Vector2d& p = profile[ring + 1];
    for (int i = 0; i < segments; ++i) {
      const auto [c, s] = turn(i, segments);
      mesh.vertices.emplace_back(p[0] * c, p[0] * s, p[1]);
    }
  }
  const auto last = base::as_index<std::int32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(0.0, 0.0, profile.back()[1]);
  const auto at = [&](std::int32_t ring, int i) { return 1 + ring * segments + i % segments; };
  for (int i = 0; i < segments; ++i) {
    mesh.faces.push_back({0, at(0, i + 1), at(0, i)});
    for (std::int32_t ring = 0; ring + 1 < rings; ++ring) {
      mesh.faces.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i + 1)});
      mesh.faces.push_back({at(ring, i), at(ring + 1, i + 1), at(ring + 1, i)});
    }
    mesh.faces.push_back({last, at(rings - 1, i), at(rings - 1, i + 1)});
  }
  if (profile.front()[1] > profile.back()[1]) {
    for (Face& f : mesh.faces) std::swap(f[1], f[2]);
  }
  return mesh;
}

}  // namespace graspfit::geometry
