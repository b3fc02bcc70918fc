#include "graspfit/hands/contact_pad.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/geometry/convex_hull.hpp"
#include "model/pad_outline.hpp"

namespace graspfit::hands {

namespace {

using internal::area_of;
using internal::Side;
using internal::sides;

double distance_inside(const std::vector<Side>& lines, const Eigen::Vector2d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const Side& line : lines) least = std::min(least, line.inward.dot(point) - line.offset);
  return lines.empty() ? 0.0 : std::max(least, 0.0);
}

/// Corners of the hull whose upper side is the pad: first the outline's at z = 0, then the
/// surface's.
std::vector<Eigen::Vector3d> hull_points(const ContactPad& pad) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector2d& corner : pad.outline) {
    points.emplace_back(corner.x(), corner.y(), 0.0);
  }
  points.insert(points.end(), pad.surface.begin(), pad.surface.end());
  return points;
}

void require_thickness(const char* function, const ContactPad& pad, double thickness) {
  if (thickness > 0.0 && std::isfinite(thickness)) return;
  throw base::InvalidInput(std::string(function) + ": pad " + pad.name + ": thickness " +
                           base::shortest_decimal(thickness) + " is not positive");
}

}  // namespace

double pad_area(const ContactPad& pad) { return area_of(pad.outline); }

double boundary_distance(const ContactPad& pad, const Eigen::Vector2d& point_C) {
  return distance_inside(sides(pad.outline), point_C);
}

double largest_boundary_distance(const ContactPad& pad) {
  // The largest inscribed circle touches three sides (or can be moved until it does), so its center
  // is among the points with equal distance r from three lines: n · c − r = offset for each.
  const std::vector<Side> lines = sides(pad.outline);
  double largest = 0.0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      for (std::size_t k = j + 1; k < lines.size(); ++k) {
        Eigen::Matrix3d system;
        Eigen::Vector3d offsets;
        int row = 0;
        for (const std::size_t s : {i, j, k}) {
          system.row(row) << lines[s].inward.x(), lines[s].inward.y(), -1.0;
          offsets[row++] = lines[s].offset;
        }
        const Eigen::FullPivLU<Eigen::Matrix3d> solver(system);
        if (!solver.isInvertible()) continue;
        const Eigen::Vector3d center = solver.solve(offsets);
        largest = std::max(largest, distance_inside(lines, center.head<2>()));
      }
    }
  }
  return largest;
}

std::vector<geometry::HalfSpace> surface_planes(const ContactPad& pad) {
  std::vector<geometry::HalfSpace> planes;
  if (pad.surface.empty()) return planes;
  const std::vector<Eigen::Vector3d> points = hull_points(pad);
  // Facets steeper than this are walls over the outline, which the outline's sides give already.
  constexpr double kWall = 1e-6;  // cosine; a facet of the bulge leans by far more
  constexpr double kSame = 1e-9;  // difference of unit normals of coplanar facets
  for (const geometry::HullFacet& facet : geometry::convex_hull(points).facets) {
    const Eigen::Vector3d& a = points[facet[0]];
    const Eigen::Vector3d normal = (points[facet[1]] - a).cross(points[facet[2]] - a).normalized();
    if (!(normal.z() > kWall)) continue;
    const bool is_known = std::any_of(
        planes.begin(), planes.end(),
        [&](const geometry::HalfSpace& plane) { return (plane.normal - normal).norm() < kSame; });
    if (!is_known) planes.push_back({normal, normal.dot(a)});
  }
  return planes;
}

double height_over_pad(const ContactPad& pad, const Eigen::Vector3d& point_C) {
  if (pad.planes.empty()) return point_C.z();
  double height = -std::numeric_limits<double>::infinity();
  for (const geometry::HalfSpace& plane : pad.planes) {
    height = std::max(height, (plane.normal.dot(point_C) - plane.offset) / plane.normal.z());
  }
  return height;
}

double pad_height(const ContactPad& pad) {
  double height = 0.0;
  for (const Eigen::Vector3d& point : pad.surface) height = std::max(height, point.z());
  return height;
}

Eigen::Vector3d pad_contact_point_C(const ContactPad& pad) {
  return {0.0, 0.0, std::max(0.0, -height_over_pad(pad, Eigen::Vector3d::Zero()))};
}

Eigen::Vector3d pad_point_toward_end_C(const ContactPad& pad, double share) {
  constexpr double kBorder = 0.002;  // [m]
  const Eigen::Vector3d touching = pad_contact_point_C(pad);
  if (!pad.surface.empty()) return touching;
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : pad.outline) box.extend(corner);
  const Eigen::Vector2d size = box.sizes();
  constexpr double kLonger = 1.2;  // than wide
  const int along = size.x() > size.y() ? 0 : 1;
  if (size[along] < kLonger * size[1 - along]) return touching;
  // Away from the link's origin, whose place in C is the inverse pose's translation.
  const Eigen::Vector3d origin_C = geometry::inverted(pad.X_LC).translation();
  const double end = origin_C[along] < 0.0 ? box.max()[along] : box.min()[along];
  Eigen::Vector3d point = touching;
  point[along] += share * std::copysign(std::max(0.0, std::abs(end) - kBorder), end);
  return point;
}

geometry::ConvexVolume clip_volume_C(const ContactPad& pad, double thickness) {
  require_thickness("clip_volume_C", pad, thickness);
  geometry::ConvexVolume volume;
  for (const Side& side : sides(pad.outline)) {
    volume.push_back({Eigen::Vector3d(-side.inward.x(), -side.inward.y(), 0.0), -side.offset});
  }
  volume.push_back({-Eigen::Vector3d::UnitZ(), 0.0});
  if (pad.planes.empty()) volume.push_back({Eigen::Vector3d::UnitZ(), thickness});
  // The surface ends at the outline as seen along z, so that moving it along z adds no further
  // walls.
  for (const geometry::HalfSpace& plane : pad.planes) {
    volume.push_back({plane.normal, plane.offset + plane.normal.z() * thickness});
  }
  return volume;
}

TriangleMesh clip_volume_mesh_C(const ContactPad& pad, double thickness) {
  require_thickness("clip_volume_mesh_C", pad, thickness);
  std::vector<Eigen::Vector3d> points = hull_points(pad);
  const std::size_t num_points = points.size();
  for (std::size_t i = 0; i < num_points; ++i) {
    points.push_back(points[i] + thickness * Eigen::Vector3d::UnitZ());
  }
  const geometry::ConvexHull3 hull = geometry::convex_hull(points);
  // The mesh has the hull's corners only: points of the pad inside the hull are left out.
  std::vector<std::int32_t> number(points.size(), -1);
  TriangleMesh mesh;
  for (const std::size_t vertex : hull.vertices) {
    number[vertex] = base::as_index<std::int32_t>(mesh.vertices.size());
    mesh.vertices.push_back(points[vertex]);
  }
  for (const geometry::HullFacet& facet : hull.facets) {
    mesh.faces.push_back({number[facet[0]], number[facet[1]], number[facet[2]]});
  }
  return mesh;
}

geometry::ConvexVolume transformed(const geometry::ConvexVolume& volume_C,
                                   const RigidTransform& X_AC) {
  geometry::ConvexVolume volume_A;
  volume_A.reserve(volume_C.size());
  for (const geometry::HalfSpace& half_space : volume_C) {
    const Eigen::Vector3d normal_A = X_AC.linear() * half_space.normal;
    volume_A.push_back({normal_A, half_space.offset + normal_A.dot(X_AC.translation())});
  }
  return volume_A;
}

}  // namespace graspfit::hands
