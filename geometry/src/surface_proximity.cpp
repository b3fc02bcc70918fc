#include "graspfit/geometry/surface_proximity.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "internal/box_tree.hpp"
#include "internal/mesh_query_impl.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Vector3d;
using internal::BoxTree;
using Corners = std::array<Vector3d, 3>;

/// Nearest points of two segments [Ericson 2005, 5.1.9].
std::pair<Vector3d, Vector3d> closest_on_segments(const Vector3d& p0, const Vector3d& p1,
                                                  const Vector3d& q0, const Vector3d& q1) {
  const Vector3d u = p1 - p0;
  const Vector3d v = q1 - q0;
  const Vector3d w = p0 - q0;
  const double a = u.squaredNorm();
  const double b = u.dot(v);
  const double c = v.squaredNorm();
  const double d = u.dot(w);
  const double e = v.dot(w);
  const double denominator = a * c - b * b;
  double s = denominator > 0.0 ? std::clamp((b * e - c * d) / denominator, 0.0, 1.0) : 0.0;
  double t = c > 0.0 ? (b * s + e) / c : 0.0;
  if (t < 0.0 || t > 1.0) {
    t = std::clamp(t, 0.0, 1.0);
    s = a > 0.0 ? std::clamp((b * t - d) / a, 0.0, 1.0) : 0.0;
  }
  return {p0 + s * u, q0 + t * v};
}

/// Where an edge of `a` passes through `b`, in rounded numbers.
std::optional<Vector3d> piercing(const Corners& a, const Corners& b) {
  const Vector3d normal = (b[1] - b[0]).cross(b[2] - b[0]);
  const std::array<double, 3> side = {normal.dot(a[0] - b[0]), normal.dot(a[1] - b[0]),
                                      normal.dot(a[2] - b[0])};
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (!(side[i] * side[j] < 0.0)) continue;
    const Vector3d point = a[i] + side[i] / (side[i] - side[j]) * (a[j] - a[i]);
    bool is_inside = true;
    for (int k = 0; k < 3 && is_inside; ++k) {
      const Vector3d& from = b[k];
      is_inside = (b[(k + 1) % 3] - from).cross(point - from).dot(normal) >= 0.0;
    }
    if (is_inside) return point;
  }
  return std::nullopt;
}

/// One search for nearest points, depth first, the nearer children first.
class Search {
 public:
  Search(const MeshQuery& a, const MeshQuery& b, const RigidTransform& X_AB, double enough)
      : a_(a.impl()),
        b_(b.impl()),
        X_AB_(X_AB),
        X_BA_(X_AB.inverse()),
        turn_(X_AB.linear().cwiseAbs()),
        bound_(enough) {}

  std::optional<SurfaceProximity> operator()(const ProximitySeed& seed) {
    if (seed.face_a >= 0 && seed.face_b >= 0) {
      const auto face_a = static_cast<std::size_t>(seed.face_a);
      const auto face_b = static_cast<std::size_t>(seed.face_b);
      improve(corners(a_.mesh, face_a), seed.face_a, mapped(corners(b_.mesh, face_b)), seed.face_b);
    }
    std::vector<Pair> open;
    push(open, 0, 0);
    while (!open.empty() && bound_ > 0.0) {
      const Pair pair = open.back();
      open.pop_back();
      if (pair.squared_gap >= bound_ * bound_) continue;
      visit(pair, open);
    }
    return best_;
  }

 private:
  struct Pair {
    double squared_gap;
    std::int32_t node_a;
    std::int32_t node_b;
  };

  Corners mapped(const Corners& c) const { return {X_AB_ * c[0], X_AB_ * c[1], X_AB_ * c[2]}; }

  /// A lower bound of the distance of two nodes, by boxes along the axes of A and along those of B:
  /// seen from one frame alone turned boxes grow, and with them the number of pairs looked at.
  double squared_gap(std::int32_t i, std::int32_t j) const {
    const BoxTree::Node& node_a = a_.tree.nodes[static_cast<std::size_t>(i)];
    const BoxTree::Node& node_b = b_.tree.nodes[static_cast<std::size_t>(j)];
    const Vector3d center = X_AB_ * Vector3d(0.5 * (node_b.lower + node_b.upper));
    const Vector3d half = turn_ * Vector3d(0.5 * (node_b.upper - node_b.lower));
    const double in_a = (node_a.lower - center - half)
                            .cwiseMax(center - half - node_a.upper)
                            .cwiseMax(0.0)
                            .squaredNorm();
    if (in_a >= bound_ * bound_) return in_a;
    const Vector3d center_a = X_BA_ * Vector3d(0.5 * (node_a.lower + node_a.upper));
    const Vector3d half_a = turn_.transpose() * Vector3d(0.5 * (node_a.upper - node_a.lower));
    return std::max(in_a, (node_b.lower - center_a - half_a)
                              .cwiseMax(center_a - half_a - node_b.upper)
                              .cwiseMax(0.0)
                              .squaredNorm());
  }

  void push(std::vector<Pair>& open, std::int32_t i, std::int32_t j) const {
    const double gap = squared_gap(i, j);
    if (gap < bound_ * bound_) open.push_back({gap, i, j});
  }

  void visit(const Pair& pair, std::vector<Pair>& open) {
    const BoxTree::Node& node_a = a_.tree.nodes[static_cast<std::size_t>(pair.node_a)];
    const BoxTree::Node& node_b = b_.tree.nodes[static_cast<std::size_t>(pair.node_b)];
    if (node_a.count > 0 && node_b.count > 0) {
      compare(node_a, node_b);
      return;
    }
    const bool splits_a =
        node_a.count == 0 && (node_b.count > 0 || (node_a.upper - node_a.lower).squaredNorm() >=
                                                      (node_b.upper - node_b.lower).squaredNorm());
    const std::size_t size = open.size();
    if (splits_a) {
      push(open, pair.node_a + 1, pair.node_b);
      push(open, node_a.first, pair.node_b);
    } else {
      push(open, pair.node_a, pair.node_b + 1);
      push(open, pair.node_a, node_b.first);
    }
    // The last one is looked at first.
    if (open.size() == size + 2 && open[size].squared_gap < open[size + 1].squared_gap) {
      std::swap(open[size], open[size + 1]);
    }
  }

  void compare(const BoxTree::Node& node_a, const BoxTree::Node& node_b) {
    for (std::int32_t t = node_b.first; t < node_b.first + node_b.count; ++t) {
      const BoxTree::Triangle& of_b = b_.tree.triangles[static_cast<std::size_t>(t)];
      const Corners corners_b = mapped(of_b.corners);
      const Vector3d lower = corners_b[0].cwiseMin(corners_b[1]).cwiseMin(corners_b[2]);
      const Vector3d upper = corners_b[0].cwiseMax(corners_b[1]).cwiseMax(corners_b[2]);
      for (std::int32_t s = node_a.first; s < node_a.first + node_a.count; ++s) {
        const BoxTree::Triangle& of_a = a_.tree.triangles[static_cast<std::size_t>(s)];
        const Corners& c = of_a.corners;
        const double apart = (c[0].cwiseMin(c[1]).cwiseMin(c[2]) - upper)
                                 .cwiseMax(lower - c[0].cwiseMax(c[1]).cwiseMax(c[2]))
                                 .cwiseMax(0.0)
                                 .squaredNorm();
        if (apart < bound_ * bound_) improve(c, of_a.face, corners_b, of_b.face);
      }
    }
  }

  void offer(const Vector3d& on_a, const Vector3d& on_b, std::int32_t face_a, std::int32_t face_b) {
    const double squared = (on_a - on_b).squaredNorm();
    if (!(squared < bound_ * bound_)) return;
    bound_ = std::sqrt(squared);
    best_ = {bound_, on_a, on_b, face_a, face_b};
  }

  /// Whether the plane of `a` has all of `b` on one side and farther than the bound.
  bool is_beyond_plane(const Corners& a, const Corners& b) const {
    const Vector3d normal = (a[1] - a[0]).cross(a[2] - a[0]);
    const double heights[3] = {normal.dot(b[0] - a[0]), normal.dot(b[1] - a[0]),
                               normal.dot(b[2] - a[0])};
    const double lowest = std::min({heights[0], heights[1], heights[2]});
    const double highest = std::max({heights[0], heights[1], heights[2]});
    const double beyond = std::max(lowest, -highest);
    return beyond > 0.0 && beyond * beyond > bound_ * bound_ * normal.squaredNorm();
  }

  /// Of two triangles that do not cross: a corner and a triangle, or two edges, are nearest.
  void improve(const Corners& a, std::int32_t face_a, const Corners& b, std::int32_t face_b) {
    if (is_beyond_plane(a, b) || is_beyond_plane(b, a)) return;
    for (const auto& [first, second] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
      if (const std::optional<Vector3d> point = piercing(*first, *second)) {
        offer(*point, *point, face_a, face_b);
        return;
      }
    }
    for (int i = 0; i < 3; ++i) {
      offer(a[i], internal::closest_on_triangle(a[i], b), face_a, face_b);
      offer(internal::closest_on_triangle(b[i], a), b[i], face_a, face_b);
      for (int j = 0; j < 3; ++j) {
        const auto [on_a, on_b] = closest_on_segments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]);
        offer(on_a, on_b, face_a, face_b);
      }
    }
  }

  const MeshQuery::Impl& a_;
  const MeshQuery::Impl& b_;
  const RigidTransform& X_AB_;
  const RigidTransform X_BA_;
  const Eigen::Matrix3d turn_;
  double bound_;
  std::optional<SurfaceProximity> best_;
};

}  // namespace

std::optional<SurfaceProximity> nearest_points(const MeshQuery& a, const MeshQuery& b,
                                               const RigidTransform& X_AB, double enough,
                                               const ProximitySeed& seed) {
  return Search(a, b, X_AB, enough)(seed);
}

}  // namespace graspfit::geometry
