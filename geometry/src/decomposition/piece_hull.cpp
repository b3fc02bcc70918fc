#include "decomposition/piece_hull.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "exact/predicates.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "hull/exact_hull.hpp"

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

std::vector<Vector3d> selected(const std::vector<Vector3d>& points,
                               const std::vector<std::size_t>& chosen) {
  std::vector<Vector3d> result;
  for (const std::size_t i : chosen) result.push_back(points[i]);
  return result;
}

/// Adds the points farthest off the plane of `corners`.
void add_off_plane(const std::vector<Vector3d>& points, const std::vector<Vector3d>& corners,
                   std::vector<std::size_t>& chosen) {
  Vector3d normal = Vector3d::Zero();
  for (std::size_t i = 1; i < corners.size(); ++i) {
    for (std::size_t j = i + 1; j < corners.size(); ++j) {
      const Vector3d cross = (corners[i] - corners[0]).cross(corners[j] - corners[0]);
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

/// The hull of points that span space.
PieceHull hull_of(const std::vector<Vector3d>& points, const ExactHull& exact) {
  PieceHull hull;
  std::vector<std::int32_t> index(points.size(), -1);
  for (const std::size_t corner : exact.corners) {
    index[corner] = base::as_index<std::int32_t>(hull.mesh.vertices.size());
    hull.mesh.vertices.push_back(points[corner]);
  }
  const auto num_faces = std::ssize(exact.triangles);
  hull.normals.resize(3, num_faces);
  hull.offsets.resize(num_faces);
  for (Eigen::Index f = 0; f < num_faces; ++f) {
    const auto& [a, b, c] = exact.triangles[f];
    hull.mesh.faces.push_back({index[a], index[b], index[c]});
    hull.normals.col(f) = accurate_vector_area(points[a], points[b], points[c]).stableNormalized();
    hull.offsets[f] = hull.normals.col(f).dot(points[a]);
  }
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
  std::vector<Vector3d> kept = selected(points, chosen);
  ExactHull exact = exact_hull(kept);
  if (exact.rank == 2) {
    std::sort(exact.corners.begin(), exact.corners.end());
    add_off_plane(points, selected(kept, exact.corners), chosen);
    kept = selected(points, chosen);
    exact = exact_hull(kept);
  }
  if (exact.rank < 3) return std::nullopt;
  std::vector<std::size_t> outside(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) outside[i] = i;
  PieceHull hull = hull_of(kept, exact);
  while (true) {
    // The plane of a face is only known to some ulps. This tolerance only saves rounds for nothing:
    // the loop ends since each point is added once, and `left_out` counts what is left.
    const double tolerance =
        std::max(options.tolerance, 1e-15 * hull.offsets.cwiseAbs().maxCoeff());
    const auto farthest = farthest_outside(points, hull, tolerance, outside);
    const std::size_t num_allowed =
        static_cast<std::size_t>(options.max_vertices) -
        std::min(static_cast<std::size_t>(options.max_vertices), hull.mesh.vertices.size());
    if (farthest.empty() || num_allowed == 0) break;
    kept = hull.mesh.vertices;
    for (std::size_t k = 0; k < std::min(num_allowed, farthest.size()); ++k) {
      kept.push_back(points[farthest[k].second]);
      // A point is added once: the hull then holds it, even if the rounded plane of a face of a
      // sharp needle says otherwise.
      std::erase(outside, farthest[k].second);
    }
    hull = hull_of(kept, exact_hull(kept));
  }
  if (width_of(hull) < options.least_width) return std::nullopt;
  hull.left_out = farthest_from(hull, points);
  return hull;
}

}  // namespace graspfit::geometry::internal
