#include "query/box_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace graspfit::geometry::internal {
namespace {

constexpr std::int32_t kLeafSize = 4;
constexpr int kNumBins = 16;

struct Item {
  Eigen::Vector3d lower;
  Eigen::Vector3d upper;
  Eigen::Vector3d middle;  // Twice the box's center.
  std::int32_t face;
};

struct Bounds {
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d upper = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());
  std::int32_t count = 0;

  void extend(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    lower = lower.cwiseMin(low);
    upper = upper.cwiseMax(high);
  }
  double half_area() const {
    const Eigen::Vector3d d = upper - lower;
    return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
  }
};

class Builder {
 public:
  Builder(const TriangleMesh& mesh, std::vector<BoxTree::Node>& nodes) : nodes_(nodes) {
    items_.reserve(mesh.faces.size());
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
      const auto [a, b, c] = corners(mesh, face);
      Item item;
      item.lower = a.cwiseMin(b).cwiseMin(c);
      item.upper = a.cwiseMax(b).cwiseMax(c);
      item.middle = item.lower + item.upper;
      item.face = static_cast<std::int32_t>(face);
      items_.push_back(item);
    }
    nodes_.reserve(items_.size());
    build(0, static_cast<std::int32_t>(items_.size()), 0);
  }

  const std::vector<Item>& items() const { return items_; }

 private:
  void build(std::int32_t begin, std::int32_t end, int depth) {
    const std::size_t index = nodes_.size();
    nodes_.emplace_back();
    Bounds box;
    Bounds middles;
    for (std::int32_t i = begin; i < end; ++i) {
      box.extend(items_[i].lower, items_[i].upper);
      middles.extend(items_[i].middle, items_[i].middle);
    }
    nodes_[index].lower = box.lower;
    nodes_[index].upper = box.upper;
    if (end - begin <= kLeafSize) {
      nodes_[index].first = begin;
      nodes_[index].count = end - begin;
      return;
    }
    const std::int32_t middle = split(begin, end, middles, depth);
    build(begin, middle, depth + 1);
    nodes_[index].first = static_cast<std::int32_t>(nodes_.size());
    build(middle, end, depth + 1);
  }

  // Splits where the surface area heuristic is least among equal bins of the longest axis; halves
  // where that gives nothing, and below a depth that only contrived input reaches.
  std::int32_t split(std::int32_t begin, std::int32_t end, const Bounds& middles, int depth) {
    int axis = 0;
    const Eigen::Vector3d extent = middles.upper - middles.lower;
    extent.maxCoeff(&axis);
    const double low = middles.lower[axis];
    const double scale = kNumBins / extent[axis];
    if (depth < 48 && extent[axis] > 0.0 && scale > 0.0 && scale < 1e300) {
      const auto bin = [&](const Item& item) {
        return std::min(kNumBins - 1, static_cast<int>((item.middle[axis] - low) * scale));
      };
      std::array<Bounds, kNumBins> bins;
      for (std::int32_t i = begin; i < end; ++i) {
        Bounds& b = bins[bin(items_[i])];
        b.extend(items_[i].lower, items_[i].upper);
        ++b.count;
      }
      std::array<double, kNumBins> cost_right{};
      Bounds right;
      for (int i = kNumBins - 1; i > 0; --i) {
        if (bins[i].count > 0) right.extend(bins[i].lower, bins[i].upper);
        right.count += bins[i].count;
        cost_right[i] = right.count > 0 ? right.count * right.half_area() : 0.0;
      }
      Bounds left;
      int best = -1;
      double best_cost = std::numeric_limits<double>::infinity();
      for (int i = 0; i + 1 < kNumBins; ++i) {
        if (bins[i].count > 0) left.extend(bins[i].lower, bins[i].upper);
        left.count += bins[i].count;
        if (left.count == 0 || left.count == end - begin) continue;
        const double cost = left.count * left.half_area() + cost_right[i + 1];
        if (cost < best_cost) {
          best_cost = cost;
          best = i;
        }
      }
      if (best >= 0) {
        const auto at = std::partition(items_.begin() + begin, items_.begin() + end,
                                       [&](const Item& item) { return bin(item) <= best; });
        return static_cast<std::int32_t>(at - items_.begin());
      }
    }
    const std::int32_t half = begin + (end - begin) / 2;
    std::nth_element(items_.begin() + begin, items_.begin() + half, items_.begin() + end,
                     [axis](const Item& p, const Item& q) {
                       return p.middle[axis] != q.middle[axis] ? p.middle[axis] < q.middle[axis]
                                                               : p.face < q.face;
                     });
    return half;
  }

  std::vector<BoxTree::Node>& nodes_;
  std::vector<Item> items_;
};

// Share of `b` in the point of the segment from a to b nearest to `point`.
double closest_on_segment(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                          const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double squared = ab.squaredNorm();
  return squared > 0.0 ? std::clamp((point - a).dot(ab) / squared, 0.0, 1.0) : 0.0;
}

}  // namespace

BoxTree::BoxTree(const TriangleMesh& mesh) {
  const Builder builder(mesh, nodes);
  triangles.reserve(mesh.faces.size());
  for (const Item& item : builder.items()) {
    triangles.push_back({corners(mesh, item.face), item.face});
  }
}

TrianglePoint nearest_on_triangle(const Eigen::Vector3d& point,
                                  const std::array<Eigen::Vector3d, 3>& corners) {
  // Regions of the triangle's plane as in [Ericson 2005, 5.1.5]: corners, edges, inside.
  const auto& [a, b, c] = corners;
  const Eigen::Vector3d ab = b - a;
  const Eigen::Vector3d ac = c - a;
  const Eigen::Vector3d ap = point - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {a, {1, 0, 0}};
  const Eigen::Vector3d bp = point - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return {b, {0, 1, 0}};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 - d3 > 0.0) {
    const double t = d1 / (d1 - d3);
    return {a + t * ab, {1.0 - t, t, 0}};
  }
  const Eigen::Vector3d cp = point - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return {c, {0, 0, 1}};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 - d6 > 0.0) {
    const double t = d2 / (d2 - d6);
    return {a + t * ac, {1.0 - t, 0, t}};
  }
  const double va = d3 * d6 - d5 * d4;
  const double along = (d4 - d3) + (d5 - d6);
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 && along > 0.0) {
    const double t = (d4 - d3) / along;
    return {b + t * (c - b), {0, 1.0 - t, t}};
  }
  const double sum = va + vb + vc;
  if (sum > 0.0 && va >= 0.0 && vb >= 0.0 && vc >= 0.0) {
    const double v = vb / sum;
    const double w = vc / sum;
    return {a + v * ab + w * ac, {std::max(0.0, 1.0 - v - w), v, w}};
  }
  // In a sliver rounding prevails: the nearest point of its edges is then as near as any inside.
  TrianglePoint best{a, {1, 0, 0}};
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const double t = closest_on_segment(point, corners[i], corners[j]);
    TrianglePoint candidate{corners[i] + t * (corners[j] - corners[i]), Eigen::Vector3d::Zero()};
    candidate.barycentric[i] = 1.0 - t;
    candidate.barycentric[j] = t;
    if ((candidate.point - point).squaredNorm() < (best.point - point).squaredNorm()) {
      best = candidate;
    }
  }
  return best;
}

QuickHit quick_first_hit(const BoxTree& tree, const Eigen::Vector3d& origin,
                         const Eigen::Vector3d& direction, std::int32_t skipped_face) {
  struct Entry {
    std::int32_t node;
    double t;
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kMargin = 1e-9;  // Of a triangle's barycentric coordinates.
  const Eigen::Array3d inverse = direction.array().inverse();
  QuickHit best;
  best.t = kInfinity;
  // Where the ray enters a box; infinity if it misses it. A zero direction gives infinite bounds,
  // or NaN in a plane of the box, which the ray then does not leave: no bound.
  const auto enter = [&](const BoxTree::Node& node) {
    double t_in = 0.0;
    double t_out = best.t;
    for (int axis = 0; axis < 3; ++axis) {
      const double t0 = (node.lower[axis] - origin[axis]) * inverse[axis];
      const double t1 = (node.upper[axis] - origin[axis]) * inverse[axis];
      if (std::isnan(t0) || std::isnan(t1)) continue;
      const double t_near = t0 < t1 ? t0 : t1;
      const double t_far = t0 < t1 ? t1 : t0;
      t_in = t_near > t_in ? t_near : t_in;
      t_out = t_far < t_out ? t_far : t_out;
    }
    return t_in <= t_out * (1.0 + 1e-12) ? t_in : kInfinity;
  };
  std::array<Entry, kMostTreeDepth> stack;
  int size = 0;
  stack[size++] = {0, enter(tree.nodes[0])};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.t == kInfinity || entry.t > best.t) continue;
    const BoxTree::Node& node = tree.nodes[entry.node];
    if (node.count == 0) {
      Entry near{entry.node + 1, enter(tree.nodes[entry.node + 1])};
      Entry far{node.first, enter(tree.nodes[node.first])};
      if (far.t < near.t) std::swap(near, far);
      if (far.t < kInfinity) stack[size++] = far;
      if (near.t < kInfinity) stack[size++] = near;
      continue;
    }
    for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
      const auto& [corners, face] = tree.triangles[i];
      if (face == skipped_face) continue;
      // [Möller & Trumbore 1997].
      const Eigen::Vector3d ab = corners[1] - corners[0];
      const Eigen::Vector3d ac = corners[2] - corners[0];
      const Eigen::Vector3d h = direction.cross(ac);
      const double signed_det = ab.dot(h);
      if (signed_det == 0.0) continue;
      const double sign = signed_det < 0.0 ? -1.0 : 1.0;
      const double det = sign * signed_det;
      const Eigen::Vector3d s = sign * (origin - corners[0]);
      const double u = s.dot(h);
      if (!(u >= -kMargin * det && u <= (1.0 + kMargin) * det)) continue;
      const Eigen::Vector3d q = s.cross(ab);
      const double v = direction.dot(q);
      if (!(v >= -kMargin * det && u + v <= (1.0 + kMargin) * det)) continue;
      const double t = ac.dot(q) / det;
      if (!(t >= 0.0)) continue;
      if (t < best.t || (t == best.t && face < tree.triangles[best.triangle].face)) {
        best = {i, t};
      }
    }
  }
  return best;
}

}  // namespace graspfit::geometry::internal
