#include "graspfit/geometry/surface_clearance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include "internal/box_tree.hpp"
#include "internal/mesh_query_impl.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Vector3d;
using internal::BoxTree;
using Corners = std::array<Vector3d, 3>;

/// Squared lower bound of the distance of a box in frame A and one in frame B, along A's axes.
double squared_gap(const BoxTree::Node& a, const BoxTree::Node& b, const RigidTransform& X_AB) {
  const Vector3d center = X_AB * Vector3d(0.5 * (b.lower + b.upper));
  const Vector3d half = X_AB.linear().cwiseAbs() * Vector3d(0.5 * (b.upper - b.lower));
  return (a.lower - center - half).cwiseMax(center - half - a.upper).cwiseMax(0.0).squaredNorm();
}

double squared_segment_distance(const Vector3d& p, const Vector3d& u, const Vector3d& q,
                                const Vector3d& v) {
  const Vector3d w = p - q;
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
  return (w + s * u - t * v).squaredNorm();
}

/// Whether a segment goes through a triangle, in doubles: where rounding decides, corners and edges
/// are as near as that.
bool pierces(const Vector3d& from, const Vector3d& to, const Corners& triangle) {
  const Vector3d ab = triangle[1] - triangle[0];
  const Vector3d ac = triangle[2] - triangle[0];
  const Vector3d normal = ab.cross(ac);
  const double side_from = normal.dot(from - triangle[0]);
  const double side_to = normal.dot(to - triangle[0]);
  if (!((side_from <= 0.0 && side_to >= 0.0) || (side_from >= 0.0 && side_to <= 0.0))) return false;
  if (side_from == side_to) return false;  // in the plane: its edges meet the triangle's
  const Vector3d point = from + side_from / (side_from - side_to) * (to - from);
  for (int i = 0; i < 3; ++i) {
    const Vector3d& corner = triangle[static_cast<std::size_t>(i)];
    const Vector3d edge = triangle[static_cast<std::size_t>((i + 1) % 3)] - corner;
    if (normal.dot(edge.cross(point - corner)) < 0.0) return false;
  }
  return true;
}

double squared_distance(const Corners& a, const Corners& b) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d& p = a[i];
    const Vector3d& p_next = a[(i + 1) % 3];
    if (pierces(p, p_next, b) || pierces(b[i], b[(i + 1) % 3], a)) return 0.0;
    best = std::min({best, (p - internal::closest_on_triangle(p, b)).squaredNorm(),
                     (b[i] - internal::closest_on_triangle(b[i], a)).squaredNorm()});
    for (std::size_t j = 0; j < 3; ++j) {
      best = std::min(best, squared_segment_distance(p, p_next - p, b[j], b[(j + 1) % 3] - b[j]));
    }
  }
  return best;
}

BoxTree::Node box_of(const Corners& c) {
  return {c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2]), 0, 1};
}

}  // namespace

double surface_clearance(const MeshQuery& a, const MeshQuery& b, const RigidTransform& X_AB,
                         double enough, double share) {
  const BoxTree& tree_a = a.impl().tree;
  const BoxTree& tree_b = b.impl().tree;
  const RigidTransform X_BA = X_AB.inverse();
  struct Pair {
    double squared_gap;
    std::int32_t node_a;
    std::int32_t node_b;
    bool operator<(const Pair& other) const { return squared_gap > other.squared_gap; }
  };
  std::priority_queue<Pair> open;
  const double squared_enough = enough * enough;
  const double squared_share = share * share;
  double best = std::numeric_limits<double>::infinity();   // squared
  double below = std::numeric_limits<double>::infinity();  // squared: of what was left out
  const auto push = [&](std::int32_t i, std::int32_t j) {
    const BoxTree::Node& node_a = tree_a.nodes[static_cast<std::size_t>(i)];
    const BoxTree::Node& node_b = tree_b.nodes[static_cast<std::size_t>(j)];
    const double gap =
        std::max(squared_gap(node_a, node_b, X_AB), squared_gap(node_b, node_a, X_BA));
    if (gap >= squared_enough) return;
    if (gap >= squared_share * best) {
      below = std::min(below, gap);
      return;
    }
    open.push({gap, i, j});
  };
  push(0, 0);
  while (!open.empty()) {
    const Pair pair = open.top();
    if (pair.squared_gap >= squared_share * best) {
      below = std::min(below, pair.squared_gap);
      break;
    }
    open.pop();
    const BoxTree::Node& node_a = tree_a.nodes[static_cast<std::size_t>(pair.node_a)];
    const BoxTree::Node& node_b = tree_b.nodes[static_cast<std::size_t>(pair.node_b)];
    if (node_a.count > 0 && node_b.count > 0) {
      for (std::int32_t t = 0; t < node_b.count; ++t) {
        const Corners& in_B = tree_b.triangles[static_cast<std::size_t>(node_b.first + t)].corners;
        const Corners triangle_b = {X_AB * in_B[0], X_AB * in_B[1], X_AB * in_B[2]};
        const BoxTree::Node box_b = box_of(triangle_b);
        for (std::int32_t s = 0; s < node_a.count; ++s) {
          const Corners& triangle_a =
              tree_a.triangles[static_cast<std::size_t>(node_a.first + s)].corners;
          const BoxTree::Node box_a = box_of(triangle_a);
          const double gap = (box_a.lower - box_b.upper)
                                 .cwiseMax(box_b.lower - box_a.upper)
                                 .cwiseMax(0.0)
                                 .squaredNorm();
          if (gap >= std::min(best, squared_enough)) continue;
          best = std::min(best, squared_distance(triangle_a, triangle_b));
        }
      }
      continue;
    }
    const bool split_a =
        node_a.count == 0 && (node_b.count > 0 || (node_a.upper - node_a.lower).squaredNorm() >=
                                                      (node_b.upper - node_b.lower).squaredNorm());
    if (split_a) {
      push(pair.node_a + 1, pair.node_b);
      push(node_a.first, pair.node_b);
    } else {
      push(pair.node_a, pair.node_b + 1);
      push(pair.node_a, node_b.first);
    }
  }
  return std::sqrt(std::min({best, below, squared_enough}));
}

}  // namespace graspfit::geometry
