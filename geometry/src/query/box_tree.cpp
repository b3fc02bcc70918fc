#include "query/box_tree.hpp"

#include <algorithm>
#include <array>
#include <limits>
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

class Builder {
 public:
  Builder(const TriangleMesh& mesh, std::vector<BoxTree::Node>& nodes)
      : mesh_(mesh), nodes_(nodes) {
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
  /// Adds the nodes of some items; returns the sum of their triangles' normals by area.
  Eigen::Vector3d build(std::int32_t begin, std::int32_t end, int depth) {
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
      Eigen::Vector3d normals = Eigen::Vector3d::Zero();
      for (std::int32_t i = begin; i < end; ++i) {
        const auto [a, b, c] = corners(mesh_, items_[i].face);
        normals += (b - a).cross(c - a);
      }
      set_slab(index, begin, end, normals);
      return normals;
    }
    const std::int32_t middle = split(begin, end, middles, depth);
    Eigen::Vector3d normals = build(begin, middle, depth + 1);
    nodes_[index].first = base::as_index<std::int32_t>(nodes_.size());
    normals += build(middle, end, depth + 1);
    set_slab(index, begin, end, normals);
    return normals;
  }

  void set_slab(std::size_t index, std::int32_t begin, std::int32_t end,
                const Eigen::Vector3d& normals) {
    BoxTree::Node& node = nodes_[index];
    const double length = normals.norm();
    node.normal =
        length > kLeastNormal ? Eigen::Vector3d(normals / length) : Eigen::Vector3d::UnitZ();
    node.low = std::numeric_limits<double>::infinity();
    node.high = -std::numeric_limits<double>::infinity();
    for (std::int32_t i = begin; i < end; ++i) {
      for (const Eigen::Vector3d& corner : corners(mesh_, items_[i].face)) {
        const double height = node.normal.dot(corner);
        node.low = std::min(node.low, height);
        node.high = std::max(node.high, height);
      }
    }
    const double of_box = node.normal.cwiseAbs().dot(node.upper - node.lower);
    node.is_flat = node.high - node.low < kFlat * of_box;
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

  const TriangleMesh& mesh_;
  std::vector<BoxTree::Node>& nodes_;
  std::vector<Item> items_;
};

}  // namespace

BoxTree::BoxTree(const TriangleMesh& mesh) {
  const Builder builder(mesh, nodes);
  triangles.reserve(mesh.faces.size());
  for (const Item& item : builder.items()) {
    triangles.push_back({corners(mesh, item.face), item.face});
  }
}

}  // namespace graspfit::geometry::internal
