#include "decomposition/piece_hull.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "graspfit/geometry/convex_polytope.hpp"
#include "graspfit/geometry/mesh_query.hpp"

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3d;

/// The points farthest along the 26 directions to the neighbors of a cube in a lattice.
std::vector<std::size_t> first_corners(const std::vector<Vector3d>& points) {
  std::vector<std::size_t> corners;
  for (int code = 0; code < 27; ++code) {
    const Vector3d direction(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
    if (direction.isZero()) continue;
    std::size_t best = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (direction.dot(points[i]) > direction.dot(points[best])) best = i;
    }
    corners.push_back(best);
  }
  return corners;
}

void make_distinct(std::vector<std::size_t>& indices) {
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

ConvexPolytope polytope_of(const std::vector<Vector3d>& points,
                           const std::vector<std::size_t>& chosen) {
  Eigen::Matrix3Xd columns(3, chosen.size());
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    columns.col(static_cast<Eigen::Index>(k)) = points[chosen[k]];
  }
  return ConvexPolytope(columns);
}

/// Adds the points farthest off the plane of a flat hull.
void add_off_plane(const std::vector<Vector3d>& points, const ConvexPolytope& flat,
                   std::vector<std::size_t>& chosen) {
  const std::vector<int>& v = flat.vertices();
  const Vector3d origin = flat.points().col(v[0]);
  Vector3d normal = Vector3d::Zero();
  for (std::size_t i = 1; i < v.size(); ++i) {
    for (std::size_t j = i + 1; j < v.size(); ++j) {
      const Vector3d cross = (Vector3d(flat.points().col(v[i])) - origin)
                                 .cross(Vector3d(flat.points().col(v[j])) - origin);
      if (cross.squaredNorm() > normal.squaredNorm()) normal = cross;
    }
  }
  const auto less = [&](const Vector3d& a, const Vector3d& b) {
    return normal.dot(a) < normal.dot(b);
  };
  const auto [low, high] = std::minmax_element(points.begin(), points.end(), less);
  chosen.push_back(static_cast<std::size_t>(low - points.begin()));
  chosen.push_back(static_cast<std::size_t>(high - points.begin()));
  make_distinct(chosen);
}

PieceHull hull_of(const ConvexPolytope& polytope) {
  PieceHull hull;
  std::vector<std::int32_t> index(static_cast<std::size_t>(polytope.points().cols()), -1);
  for (const int v : polytope.vertices()) {
    index[v] = static_cast<std::int32_t>(hull.mesh.vertices.size());
    hull.mesh.vertices.emplace_back(polytope.points().col(v));
  }
  for (Eigen::Index f = 0; f < polytope.num_facets(); ++f) {
    const Eigen::Vector3i corners = polytope.facets().col(f);
    hull.mesh.faces.push_back({index[corners[0]], index[corners[1]], index[corners[2]]});
  }
  hull.normals = polytope.normals();
  hull.offsets = polytope.offsets();
  return hull;
}

double width_of(const PieceHull& hull) {
  double width = std::numeric_limits<double>::infinity();
  for (Eigen::Index f = 0; f < hull.normals.cols(); ++f) {
    double thickness = 0.0;
    for (const Vector3d& v : hull.mesh.vertices) {
      thickness = std::max(thickness, hull.offsets[f] - hull.normals.col(f).dot(v));
    }
    width = std::min(width, thickness);
  }
  return width;
}

/// Removes points that are in the hull or close enough to it, and returns the farthest one beyond
/// each face with its distance, farthest first.
std::vector<std::pair<double, std::size_t>> farthest_outside(const std::vector<Vector3d>& points,
                                                             const PieceHull& hull,
                                                             double tolerance,
                                                             std::vector<std::size_t>& outside) {
  std::vector<std::pair<double, std::size_t>> farthest(
      static_cast<std::size_t>(hull.normals.cols()), {tolerance, points.size()});
  std::vector<std::size_t> left;
  for (const std::size_t i : outside) {
    Eigen::Index face = 0;
    const double height = (hull.normals.transpose() * points[i] - hull.offsets).maxCoeff(&face);
    if (!(height > tolerance)) continue;
    left.push_back(i);
    if (height > farthest[face].first) farthest[face] = {height, i};
  }
  outside = std::move(left);
  std::erase_if(farthest, [&](const auto& entry) { return entry.second == points.size(); });
  std::sort(farthest.begin(), farthest.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  return farthest;
}

double farthest_from(const PieceHull& hull, const std::vector<Vector3d>& points) {
  double farthest = 0.0;
  std::optional<MeshQuery> surface;
  for (const Vector3d& point : points) {
    if (hull.height(point) <= 0.0) continue;
    if (!surface) surface.emplace(hull.mesh);
    farthest = std::max(farthest, std::sqrt(surface->closest_point(point).squared_distance));
  }
  return farthest;
}

}  // namespace

std::optional<PieceHull> piece_hull(const std::vector<Vector3d>& points,
                                    const PieceHullOptions& options) {
  if (points.size() < 4) return std::nullopt;
  std::vector<std::size_t> chosen = first_corners(points);
  make_distinct(chosen);
  ConvexPolytope polytope = polytope_of(points, chosen);
  if (polytope.rank() == 2) {
    add_off_plane(points, polytope, chosen);
    polytope = polytope_of(points, chosen);
  }
  if (polytope.rank() < 3) return std::nullopt;
  std::vector<std::size_t> outside(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) outside[i] = i;
  PieceHull hull = hull_of(polytope);
  while (true) {
    // The plane of a face of a nearly flat hull is only known to some ulps.
    const double tolerance =
        std::max(options.tolerance, 1e-15 * hull.offsets.cwiseAbs().maxCoeff());
    const auto farthest = farthest_outside(points, hull, tolerance, outside);
    const std::size_t room =
        static_cast<std::size_t>(options.max_vertices) -
        std::min(static_cast<std::size_t>(options.max_vertices), hull.mesh.vertices.size());
    if (farthest.empty() || room == 0) break;
    chosen.clear();
    std::vector<Vector3d> kept = hull.mesh.vertices;
    for (std::size_t k = 0; k < std::min(room, farthest.size()); ++k) {
      kept.push_back(points[farthest[k].second]);
      // A point is added once: the hull then holds it, even if the rounded plane of a face of a
      // sharp needle says otherwise.
      std::erase(outside, farthest[k].second);
    }
    chosen.resize(kept.size());
    for (std::size_t k = 0; k < kept.size(); ++k) chosen[k] = k;
    hull = hull_of(polytope_of(kept, chosen));
  }
  if (width_of(hull) < options.least_width) return std::nullopt;
  hull.left_out = farthest_from(hull, points);
  return hull;
}

}  // namespace graspfit::geometry::internal
