#include "query/box_tree.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>

#include "graspfit/base/as_index.hpp"

namespace graspfit::geometry::internal {
namespace {

constexpr std::int32_t kLeafSize = 4;
constexpr int kNumBins = 16;
// Slabs not thinner than this tell bodies apart too seldom for what looking at them costs.
constexpr double kFlat = 0.2;  // of the box along the slab's normal
// Squares of a sum of faces' normals below it may underflow [m²].
constexpr double kLeastNormal = 1e-140;

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

/// Splits the faces of a mesh, box by box.
class Builder {
 public:
  Builder(const TriangleMesh& mesh, std::vector<BoxTree::Node>& nodes) : nodes_(nodes) {
    items_.reserve(mesh.faces.size());
    for (std::int32_t face = 0; face < std::ssize(mesh.faces); ++face) {
      const auto [a, b, c] = corners(mesh, face);
      Item item;
      item.lower = a.cwiseMin(b).cwiseMin(c);
      item.upper = a.cwiseMax(b).cwiseMax(c);
      item.middle = item.lower + item.upper;
      item.face = face;
      items_.push_back(item);
    }
    nodes_.reserve(items_.size());
    build(0, base::as_index<std::int32_t>(items_.size()), 0);
  }

  const std::vector<Item>& items() const { return items_; }

 private:
  /// Adds the nodes of some items.
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
    nodes_[index].first = base::as_index<std::int32_t>(nodes_.size());
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

/// The slab of a node around some triangles, whose normals by area add up to `normals`.
void set_slab(BoxTree::Node& node, std::span<const IndexedTriangle> triangles,
              const Eigen::Vector3d& normals) {
  const double length = normals.norm();
  node.normal =
      length > kLeastNormal ? Eigen::Vector3d(normals / length) : Eigen::Vector3d::UnitZ();
  node.low = std::numeric_limits<double>::infinity();
  node.high = -std::numeric_limits<double>::infinity();
  const double thick = kFlat * node.normal.cwiseAbs().dot(node.upper - node.lower);
  const auto add = [&](const IndexedTriangle& triangle) {
    for (const Eigen::Vector3d& corner : triangle.corners) {
      const double height = node.normal.dot(corner);
      node.low = std::min(node.low, height);
      node.high = std::max(node.high, height);
    }
    return node.high - node.low < thick;
  };
  // Most nodes of many triangles are seen not to be flat by some of them.
  const std::size_t stride = std::max<std::size_t>(1, triangles.size() / kNumBins);
  node.is_flat = true;
  for (std::size_t i = 0; i < triangles.size() && node.is_flat; i += stride) {
    node.is_flat = add(triangles[i]);
  }
  if (stride == 1) return;
  for (std::size_t i = 0; i < triangles.size() && node.is_flat; ++i) {
    node.is_flat = add(triangles[i]);
  }
}

}  // namespace

BoxTree::BoxTree(const TriangleMesh& mesh) {
  const Builder builder(mesh, nodes);
  triangles.reserve(mesh.faces.size());
  for (const Item& item : builder.items()) {
    triangles.push_back({corners(mesh, item.face), item.face});
  }
  // Per node: how many triangles are below it, and the sum of their normals by area. Children come
  // after their parents.
  struct Below {
    std::int32_t first = 0;
    std::int32_t count = 0;
    Eigen::Vector3d normals = Eigen::Vector3d::Zero();
  };
  std::vector<Below> below(nodes.size());
  for (std::size_t i = nodes.size(); i-- > 0;) {
    Node& node = nodes[i];
    if (node.count > 0) {
      below[i] = {node.first, node.count};
      for (std::int32_t t = node.first; t < node.first + node.count; ++t) {
        const auto& [a, b, c] = triangles[t].corners;
        below[i].normals += (b - a).cross(c - a);
      }
    } else {
      const Below& left = below[i + 1];
      const Below& right = below[node.first];
      below[i] = {left.first, left.count + right.count, left.normals + right.normals};
    }
    set_slab(node, std::span(triangles).subspan(below[i].first, below[i].count), below[i].normals);
  }
}

}  // namespace graspfit::geometry::internal
