#include "internal/piece_measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "graspfit/geometry/mesh_query.hpp"

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3d;

constexpr double kToleranceRel = 0.05;  // of a bound, for what is deeper than the tolerance

struct Cube {
  Vector3d center;
  double half = 0.0;  ///< Half an edge.
};

struct Candidate {
  double most = 0.0;  ///< No place in the cube is farther out [m].
  std::size_t piece = 0;
  Cube cube;
  double distance = 0.0;  ///< Of the cube's center from the surface [m].
  bool is_outside = false;
  bool operator<(const Candidate& other) const { return most < other.most; }
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

double outward_deviation(std::span<const PieceHull> pieces, const MeshQuery& solid,
                         const OutwardOptions& options) {
  const double to_corner = std::sqrt(3.0);
  constexpr double kSlack = 1.0 + 1e-9;  // more than rounding of distances
  std::vector<Candidate> pending;        // a heap, the one that may reach farthest on top
  double known = options.floor;          // or reached by a point of a piece
  const auto add = [&](std::size_t p, const Cube& cube, const Candidate* parent) {
    if (!may_meet(pieces[p], cube)) return;
    const double radius = to_corner * cube.half;
    const double distance = std::sqrt(solid.closest_point(cube.center).squared_distance);
    if (distance + radius <= std::max(known, options.tolerance)) return;
    // The centers of a cube and of its eighths are as far apart as the eighth is large.
    const bool is_outside = parent != nullptr && parent->distance > kSlack * radius
                                ? parent->is_outside
                                : solid.containment(cube.center) == Containment::Outside;
    if (is_outside && pieces[p].height(cube.center) <= 0.0) known = std::max(known, distance);
    const double most = is_outside ? distance + radius : radius - distance;
    if (most <= std::max(known, options.tolerance)) return;
    pending.push_back({most, p, cube, distance, is_outside});
    std::push_heap(pending.begin(), pending.end());
  };
  for (std::size_t p = 0; p < pieces.size(); ++p) add(p, cube_around(pieces[p]), nullptr);
  while (!pending.empty()) {
    const Candidate top = pending.front();
    // A deep hollow may be as deep over a whole sheet of places, too many for a small tolerance.
    if (top.most <= known + std::max(options.tolerance, kToleranceRel * known)) {
      return std::max(known, top.most);
    }
    std::pop_heap(pending.begin(), pending.end());
    pending.pop_back();
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d step(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5,
                          corner & 4 ? 0.5 : -0.5);
      add(top.piece, {top.cube.center + top.cube.half * step, 0.5 * top.cube.half}, &top);
    }
  }
  // What was left out cannot reach farther than this.
  return std::max(known, pieces.empty() ? 0.0 : options.tolerance);
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
