#include "query/one_sided_distance.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

#include "query/indexed_triangle.hpp"

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3d;

class Search {
 public:
  Search(const MeshQuery& surface, double tolerance) : surface_(surface), tolerance_(tolerance) {}

  OneSidedDistance run(const std::vector<Corners>& triangles, int max_steps) {
    for (const Corners& triangle : triangles) push(triangle);
    for (int step = 0; step < max_steps && !open_.empty(); ++step) {
      if (open_.top().bound <= found_.lower + tolerance_) break;
      const Corners triangle = open_.top().corners;
      open_.pop();
      for (const Corners& quarter : quarters_of(triangle)) push(quarter);
    }
    found_.upper = found_.lower;
    if (!open_.empty()) found_.upper = std::max(found_.upper, open_.top().bound);
    return found_;
  }

 private:
  struct Item {
    double bound;
    Corners corners;
    bool operator<(const Item& other) const { return bound < other.bound; }
  };

  void push(const Corners& corners) {
    const Vector3d center = (corners[0] + corners[1] + corners[2]) / 3.0;
    const ClosestPoint closest = surface_.closest_point(center);
    const double distance = std::sqrt(closest.squared_distance);
    if (distance > found_.lower) {
      found_.lower = distance;
      found_.point = center;
      found_.nearest = closest.point;
    }
    // No point of the triangle is farther from the surface than the center's distance plus the
    // distance to the center. Nor is it farther than from the face nearest to the center, and the
    // distance to this face, which is convex, is largest at a corner.
    double radius = 0.0;
    for (const Vector3d& corner : corners) radius = std::max(radius, (corner - center).norm());
    double bound = distance + radius;
    if (bound <= found_.lower) return;
    const Corners face = geometry::corners(surface_.mesh(), closest.face);
    double to_face = 0.0;
    for (const Vector3d& corner : corners) {
      to_face = std::max(to_face, (corner - closest_on_triangle(corner, face)).norm());
    }
    bound = std::min(bound, to_face);
    if (bound <= found_.lower) return;
    // A corner that is itself as far as the bound ends the search there.
    for (const Vector3d& corner : corners) {
      if ((corner - closest_on_triangle(corner, face)).norm() <= found_.lower) continue;
      const ClosestPoint of_corner = surface_.closest_point(corner);
      const double far = std::sqrt(of_corner.squared_distance);
      if (far <= found_.lower) continue;
      found_.lower = far;
      found_.point = corner;
      found_.nearest = of_corner.point;
    }
    if (bound > found_.lower) open_.push({bound, corners});
  }

  const MeshQuery& surface_;
  const double tolerance_;
  OneSidedDistance found_;
  std::priority_queue<Item> open_;
};

}  // namespace

std::vector<Corners> triangles_of(const std::vector<Vector3d>& vertices,
                                  const std::vector<Face>& faces) {
  std::vector<Corners> triangles;
  triangles.reserve(faces.size());
  for (const Face& f : faces) triangles.push_back({vertices[f[0]], vertices[f[1]], vertices[f[2]]});
  return triangles;
}

OneSidedDistance one_sided_distance(const std::vector<Corners>& triangles, const MeshQuery& surface,
                                    const HausdorffOptions& options) {
  OneSidedDistance found = Search(surface, options.tolerance).run(triangles, options.max_steps);
  double size = surface.box().min().cwiseAbs().cwiseMax(surface.box().max().cwiseAbs()).maxCoeff();
  for (const Corners& triangle : triangles) {
    for (const Vector3d& corner : triangle) size = std::max(size, corner.cwiseAbs().maxCoeff());
  }
  // In units of u = 2^-53 of the coordinates a bound is off by 52: the nearest point by 21, its
  // distance by 12, the radius by 12, their sum by 7. The four parts of a triangle have rounded
  // corners, and cover it up to sqrt(3) a level: 146 after 54 levels, when nothing is left to
  // halve. The last addition takes 4. 180 are added.
  if (!triangles.empty()) found.upper += 2e-14 * size;
  return found;
}

}  // namespace graspfit::geometry::internal
