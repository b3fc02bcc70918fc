#include "decomposition/piece_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "graspfit/geometry/mesh_query.hpp"

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3d;

constexpr double kToleranceRel = 0.05;  // tolerance over the bound, if above the absolute one

struct Cube {
  Vector3d center;
  double half = 0.0;  ///< Half an edge.
};

/// A ball in the solid; radius 0 means that there is none.
struct Ball {
  Vector3d center = Vector3d::Zero();
  double radius = 0.0;
};

struct Candidate {
  double most = 0.0;  ///< No point of the piece in the cube is farther out of the solid than this
                      ///< [m].
  std::size_t piece = 0;
  Cube cube;
  double distance = 0.0;  ///< Of the cube's center from the surface [m].
  bool is_outside = false;
  Ball ball;  ///< The ball below the cube that gives the best bound.
  bool operator<(const Candidate& other) const { return most < other.most; }
};

/// The plane of a hull's face beside a cube.
struct FacePlane {
  Vector3d normal = Vector3d::Zero();
  double offset = 0.0;
  double half_width = 0.0;     ///< Of the cube along the normal [m].
  double center_height = 0.0;  ///< Of the cube's center over the plane [m].
};

const double kToCorner = std::sqrt(3.0);

/// A hull with precomputed data for queries about cubes.
class CubeFilter {
 public:
  explicit CubeFilter(const PieceHull& hull)
      : hull_(hull),
        surface_(hull.mesh),
        reach_(hull.normals.cwiseAbs().colwise().sum().transpose()) {}

  /// The plane of the face over which the cube's center is highest, or below which it is least
  /// deep; empty if the cube and the hull are disjoint. Planes of faces alone do not show that
  /// cubes beyond a sharp edge are disjoint from the hull: above a sliver of 10 µm they would leave
  /// cubes of that size everywhere.
  std::optional<FacePlane> plane_at(const Cube& cube) const {
    const Eigen::VectorXd heights = hull_.normals.transpose() * cube.center - hull_.offsets;
    if ((heights.array() > cube.half * reach_.array()).any()) return std::nullopt;
    Eigen::Index f = 0;
    const double height = heights.maxCoeff(&f);
    const double radius = kToCorner * cube.half;
    // More than the rounding of distances, at most 3e-13 of the coordinates, for cubes above 3e-4
    // of these. What a smaller cube drops lies within three times that rounding of its corner, and
    // a neighbor has the rest.
    constexpr double kSlack = 1.0 + 1e-9;
    if (height > 0.0 &&
        surface_.closest_point(cube.center).squared_distance > kSlack * radius * radius) {
      return std::nullopt;
    }
    return FacePlane{hull_.normals.col(f), hull_.offsets[f], cube.half * reach_[f], height};
  }

 private:
  const PieceHull& hull_;
  MeshQuery surface_;
  Eigen::VectorXd reach_;  ///< Half width of a cube of half edge 1 along each normal.
};

/// Upper bound of the distance from the ball to any point of the cube below the plane [m]. As the
/// ball is in the solid, no such point is farther out of the solid than that. On a flat surface,
/// over a ball of radius t, the bound for a small cube of radius r is about r² / 2t, far less than
/// the bound r from the cube alone.
double distance_bound(const Cube& cube, const FacePlane& plane, const Ball& ball) {
  if (!(ball.radius > 0.0)) return std::numeric_limits<double>::infinity();
  const Vector3d away = cube.center - ball.center;
  const double middle = plane.normal.dot(away);
  const double highest =
      middle + std::min(plane.half_width, -plane.center_height);  // where the hull ends
  const double lowest = middle - plane.half_width;
  const double aside = (away - middle * plane.normal).norm() + kToCorner * cube.half;
  return std::hypot(std::max(std::abs(highest), std::abs(lowest)), aside) - ball.radius;
}

Cube cube_around(const PieceHull& hull) {
  const Eigen::AlignedBox3d box = bounding_box(hull.mesh);
  return {box.center(), 0.5 * box.sizes().maxCoeff()};
}

using Segment = std::pair<double, double>;

/// The part of the line through `origin` along x in the hull; empty if first > second.
Segment interval_in(const PieceHull& hull, const Vector3d& origin) {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  const Eigen::VectorXd slack = hull.offsets - hull.normals.transpose() * origin;
  for (Eigen::Index f = 0; f < slack.size(); ++f) {
    const double slope = hull.normals(0, f);
    if (slope > 0.0) {
      high = std::min(high, slack[f] / slope);
    } else if (slope < 0.0) {
      low = std::max(low, slack[f] / slope);
    } else if (slack[f] < 0.0) {
      return {1.0, 0.0};
    }
  }
  return {low, high};
}

double united_length(std::vector<Segment>& intervals) {
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
  constexpr double kSlack = 1.0 + 1e-9;                  // see `CubeFilter::plane_at`
  constexpr std::array<double, 2> kDepths = {4.0, 1.0};  // depths of balls, over the cube's radius
  std::vector<CubeFilter> filters(pieces.begin(), pieces.end());
  std::vector<Candidate> pending;  // a heap, the one that may reach farthest on top
  double known = options.floor;    // the floor, or what a point of a piece reaches
  const auto ball_at = [&](const Vector3d& center) {
    const double distance = std::sqrt(solid.closest_point(center).squared_distance);
    return Ball{center, solid.containment(center) == Containment::Inside ? distance : 0.0};
  };
  const auto add = [&](std::size_t p, const Cube& cube, const Candidate* parent) {
    const std::optional<FacePlane> plane = filters[p].plane_at(cube);
    if (!plane) return;
    Candidate next{0.0, p, cube, 0.0, false, parent != nullptr ? parent->ball : Ball{}};
    const double enough = std::max(known, options.tolerance);
    next.most = distance_bound(cube, *plane, next.ball);
    if (next.most <= enough) return;
    const double radius = kToCorner * cube.half;
    next.distance = std::sqrt(solid.closest_point(cube.center).squared_distance);
    if (next.distance + radius <= enough) return;
    // The centers of a cube and of one of its eighths are as far apart as the radius of the eighth.
    next.is_outside = parent != nullptr && parent->distance > kSlack * radius
                          ? parent->is_outside
                          : solid.containment(cube.center) == Containment::Outside;
    if (next.is_outside && plane->center_height <= 0.0) known = std::max(known, next.distance);
    next.most =
        std::min(next.most, next.is_outside ? next.distance + radius : radius - next.distance);
    for (const double depth : kDepths) {
      if (next.most <= std::max(known, options.tolerance)) return;
      const Ball ball =
          ball_at(cube.center - (plane->center_height + depth * radius) * plane->normal);
      const double bound = distance_bound(cube, *plane, ball);
      if (bound < next.most) {
        next.most = bound;
        next.ball = ball;
      }
    }
    if (next.most <= std::max(known, options.tolerance)) return;
    pending.push_back(next);
    std::push_heap(pending.begin(), pending.end());
  };
  for (std::size_t p = 0; p < pieces.size(); ++p) add(p, cube_around(pieces[p]), nullptr);
  while (!pending.empty()) {
    const Candidate top = pending.front();
    // A deep hollow may be equally deep over a whole sheet, which has too many cubes for a small
    // tolerance.
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
  // The cubes that were left out cannot reach farther than this.
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
  std::vector<Segment> intervals;
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
        const Segment interval = interval_in(pieces[p], origin);
        if (interval.first < interval.second) intervals.push_back(interval);
      }
      sum += united_length(intervals) - length_inside(solid, origin);
    }
  }
  return sum * step_y * step_z;
}

}  // namespace graspfit::geometry::internal
