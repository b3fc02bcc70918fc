#include "graspfit/hands/pad_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/convex_hull.hpp"

namespace graspfit::hands {
namespace {

using Eigen::Vector3d;
using Polygon = std::vector<Vector3d>;

/// The part of a convex polygon to the left of the line from `a` to `b`, seen along z.
Polygon left_of(const Polygon& polygon, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const auto side = [&](const Vector3d& p) {
    return along.x() * (p.y() - a.y()) - along.y() * (p.x() - a.x());
  };
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d& p = polygon[i];
    const Vector3d& q = polygon[(i + 1) % polygon.size()];
    const double at_p = side(p);
    const double at_q = side(q);
    if (at_p >= 0.0) kept.push_back(p);
    if ((at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0)) {
      kept.push_back(p + at_p / (at_p - at_q) * (q - p));
    }
  }
  return kept;
}

void add_fan(TriangleMesh& mesh, const Polygon& polygon_C, const RigidTransform& X_LC) {
  const auto first = base::as_index<std::int32_t>(mesh.vertices.size());
  for (const Vector3d& corner : polygon_C) mesh.vertices.push_back(X_LC * corner);
  for (std::int32_t i = 2; i < std::ssize(polygon_C); ++i) {
    mesh.faces.push_back({first, first + i - 1, first + i});
  }
}

TriangleMesh modeled_surface_L(const ContactPad& pad) {
  Polygon points;
  for (const Eigen::Vector2d& corner : pad.outline) points.emplace_back(corner.x(), corner.y(), 0);
  TriangleMesh mesh;
  if (pad.surface.empty()) {
    add_fan(mesh, points, pad.X_LC);
    return mesh;
  }
  points.insert(points.end(), pad.surface.begin(), pad.surface.end());
  for (const geometry::HullFacet& facet : geometry::convex_hull(points).facets) {
    const Polygon triangle = {points[facet[0]], points[facet[1]], points[facet[2]]};
    const Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    if (normal.z() > 0.0) add_fan(mesh, triangle, pad.X_LC);
  }
  return mesh;
}

}  // namespace

TriangleMesh pad_surface_L(const HandModel& model, int pad_index) {
  if (pad_index < 0 || pad_index >= std::ssize(model.pads)) {
    throw base::InvalidInput("pad_surface_L: hand " + model.name + ": pad " +
                             std::to_string(pad_index) + " of " +
                             std::to_string(model.pads.size()));
  }
  const ContactPad& pad = model.pads[pad_index];
  const TriangleMesh& link = model.links[pad.link].mesh_L;
  const RigidTransform X_CL = geometry::inverted(pad.X_LC);
  Eigen::AlignedBox2d outline;
  for (const Eigen::Vector2d& corner : pad.outline) outline.extend(corner);
  TriangleMesh surface;
  std::vector<Vector3d> vertices_C;
  vertices_C.reserve(link.vertices.size());
  for (const Vector3d& vertex : link.vertices) vertices_C.push_back(X_CL * vertex);
  for (const auto& face : link.faces) {
    Polygon polygon;
    Eigen::AlignedBox2d box;
    for (const std::int32_t vertex : face) {
      polygon.push_back(vertices_C[vertex]);
      box.extend(polygon.back().head<2>());
    }
    if (!box.intersects(outline)) continue;
    const Vector3d normal = (polygon[1] - polygon[0]).cross(polygon[2] - polygon[0]);
    if (!(normal.z() > 0.0)) continue;
    for (std::size_t i = 0; i < pad.outline.size() && !polygon.empty(); ++i) {
      polygon = left_of(polygon, pad.outline[i], pad.outline[(i + 1) % pad.outline.size()]);
    }
    const bool is_deep = std::all_of(polygon.begin(), polygon.end(), [&](const Vector3d& corner) {
      return height_over_pad(pad, corner) < -kPadDepth;
    });
    if (polygon.size() >= 3 && !is_deep) add_fan(surface, polygon, pad.X_LC);
  }
  return surface.faces.empty() ? modeled_surface_L(pad) : surface;
}

}  // namespace graspfit::hands
