#include "mesh/vertex_welding.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "graspfit/base/as_index.hpp"

namespace graspfit::geometry::internal {
namespace {

template <typename Number>
struct Hash {
  std::size_t operator()(const std::array<Number, 3>& key) const {
    std::uint64_t h = 0;
    for (const Number x : key) {
      h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15;
      h ^= h >> 32;
    }
    return h;
  }
};

}  // namespace

std::vector<std::int32_t> weld_equal(std::vector<Eigen::Vector3d>& vertices) {
  std::unordered_map<std::array<double, 3>, std::int32_t, Hash<double>> seen;
  seen.reserve(vertices.size());
  std::vector<std::int32_t> target(vertices.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector3d p = vertices[i].array() + 0.0;
    const auto [entry, is_new] =
        seen.try_emplace({p[0], p[1], p[2]}, base::as_index<std::int32_t>(kept));
    if (is_new) vertices[kept++] = p;
    target[i] = entry->second;
  }
  vertices.resize(kept);
  return target;
}

std::vector<std::int32_t> weld_near(std::vector<Eigen::Vector3d>& vertices, double distance) {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  if (!vertices.empty()) origin = vertices.front();
  Eigen::Vector3d end = origin;
  for (const Eigen::Vector3d& p : vertices) {
    origin = origin.cwiseMin(p);
    end = end.cwiseMax(p);
  }
  // Cells a little wider than the distance, so that rounding loses no neighbor: those that a vertex
  // is to join lie in its own cell or one of the 26 around it. A difference from the origin is off
  // by 2^-53 of the extent, and a quotient by as much of itself: both less than 2^-13 cells, if no
  // cell is smaller than 2^-40 of the extent.
  const double cell_size = std::max(1.001 * distance, 0x1p-40 * (end - origin).maxCoeff());
  // Where differences of coordinates overflow, there are no cells.
  if (!std::isfinite(cell_size)) return weld_equal(vertices);
  using Cell = std::array<std::int64_t, 3>;
  std::unordered_map<Cell, std::vector<std::int32_t>, Hash<std::int64_t>> kept_in_cell;
  std::vector<std::int32_t> target(vertices.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector3d p = vertices[i].array() + 0.0;
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
      cell[axis] = static_cast<std::int64_t>(std::floor((p[axis] - origin[axis]) / cell_size));
    }
    auto first = base::as_index<std::int32_t>(kept);
    for (int neighbor = 0; neighbor < 27; ++neighbor) {
      const auto found = kept_in_cell.find(
          {cell[0] + neighbor % 3 - 1, cell[1] + neighbor / 3 % 3 - 1, cell[2] + neighbor / 9 - 1});
      if (found == kept_in_cell.end()) continue;
      for (const std::int32_t other : found->second) {
        if (other < first && (vertices[other] - p).stableNorm() <= distance) {
          first = other;
        }
      }
    }
    target[i] = first;
    if (std::cmp_less(first, kept)) continue;
    kept_in_cell[cell].push_back(first);
    vertices[kept++] = p;
  }
  vertices.resize(kept);
  return target;
}

}  // namespace graspfit::geometry::internal
