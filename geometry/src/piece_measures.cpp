#include "internal/piece_measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "graspfit/geometry/mesh_query.hpp"

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3d;

struct Cube {
  Vector3d center;
  double half = 0.0;  ///< Half an edge.
};

/// Whether a cube may meet the hull: false only if a face's plane separates them.
bool may_meet(const PieceHull& hull, const Cube& cube) {
  const Eigen::ArrayXd reach = hull.normals.cwiseAbs().colwise().sum().transpose().array();
  return ((hull.normals.transpose() * cube.center - hull.offsets).array() <= cube.half * reach)
      .all();
}

Cube cube_around(const PieceHull& hull) {
  const Eigen::AlignedBox3d box = bounding_box(hull.mesh);
  return {box.center(), 0.5 * box.sizes().maxCoeff()};
}

using Interval = std::pair<double, double>;

/// The part of the line through `origin` along x in the hull; empty if first > second.
Interval interval_in(const PieceHull& hull, const Vector3d& origin) {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  const Eigen::VectorXd room = hull.offsets - hull.normals.transpose() * origin;
  for (Eigen::Index f = 0; f < room.size(); ++f) {
    const double slope = hull.normals(0, f);
    if (slope > 0.0) {
      high = std::min(high, room[f] / slope);
    } else if (slope < 0.0) {
      low = std::max(low, room[f] / slope);
    } else if (room[f] < 0.0) {
      return {1.0, 0.0};
    }
  }
  return {low, high};
}

double united_length(std::vector<Interval>& intervals) {
  std::sort(intervals.begin(), intervals.end());
  double length = 0.0;
  double reached = -std::numeric_limits<double>::infinity();
  for (const auto& [low, high] : intervals) {
    if (high <= reached) continue;
    length += high - std::max(low, reached);
    reached = high;
  }
  return length;
}

double length_inside(const MeshQuery& solid, const Vector3d& origin) {
  double length = 0.0;
  int winding = 0;
  double entered = 0.0;
  for (const RayHit& hit : solid.all_hits(origin, Vector3d::UnitX(), LineKind::Line)) {
    const bool was_inside = winding != 0;
    winding -= hit.crossing;
    if (!was_inside && winding != 0) entered = hit.distance;
    if (was_inside && winding == 0) length += hit.distance - entered;
  }
  return length;
}

}  // namespace

double outward_deviation(const std::vector<PieceHull>& pieces, const MeshQuery& solid,
                         double tolerance) {
  const double to_corner = std::sqrt(3.0);
  double known = 0.0;  // reached by a point of a piece
  double bound = 0.0;  // by what was too small to look at further
  for (const PieceHull& piece : pieces) {
    std::vector<Cube> todo = {cube_around(piece)};
    while (!todo.empty()) {
      const Cube cube = todo.back();
      todo.pop_back();
      if (!may_meet(piece, cube)) continue;
      const double radius = to_corner * cube.half;
      const double distance = std::sqrt(solid.closest_point(cube.center).squared_distance);
      if (distance + radius <= std::max(known, bound)) continue;
      // Within the cube no place is farther out than this.
      const bool is_outside = solid.containment(cube.center) == Containment::Outside;
      const double most = is_outside ? distance + radius : radius - distance;
      if (most <= std::max(known, bound)) continue;
      if (is_outside && piece.height(cube.center) <= 0.0) known = std::max(known, distance);
      if (2.0 * radius <= tolerance) {
        bound = std::max(bound, most);
        continue;
      }
      for (int corner = 0; corner < 8; ++corner) {
        const Vector3d step(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5,
                            corner & 4 ? 0.5 : -0.5);
        todo.push_back({cube.center + cube.half * step, 0.5 * cube.half});
      }
    }
  }
  return std::max(known, bound);
}

double volume_difference(const std::vector<PieceHull>& pieces, const MeshQuery& solid,
                         int num_lines) {
  Eigen::AlignedBox3d box = solid.box();
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const PieceHull& piece : pieces) {
    boxes.push_back(bounding_box(piece.mesh));
    box.extend(boxes.back());
  }
  const double step_y = box.sizes()[1] / num_lines;
  const double step_z = box.sizes()[2] / num_lines;
  double sum = 0.0;
  std::vector<Interval> intervals;
  for (int k = 0; k < num_lines; ++k) {
    for (int j = 0; j < num_lines; ++j) {
      const Vector3d origin(box.min()[0] - step_y, box.min()[1] + (j + 0.5) * step_y,
                            box.min()[2] + (k + 0.5) * step_z);
      intervals.clear();
      for (std::size_t p = 0; p < pieces.size(); ++p) {
        if (origin[1] < boxes[p].min()[1] || origin[1] > boxes[p].max()[1] ||
            origin[2] < boxes[p].min()[2] || origin[2] > boxes[p].max()[2]) {
          continue;
        }
        const Interval interval = interval_in(pieces[p], origin);
        if (interval.first < interval.second) intervals.push_back(interval);
      }
      sum += united_length(intervals) - length_inside(solid, origin);
    }
  }
  return sum * step_y * step_z;
}

}  // namespace graspfit::geometry::internal
