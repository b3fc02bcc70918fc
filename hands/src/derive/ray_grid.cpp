#include "derive/ray_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "graspfit/base/bounded_integer.hpp"

namespace graspfit::hands::internal {

using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::MeshQuery;

namespace {

constexpr int kNumRays = 40;       // along the longer side; 1 to 2 mm on a finger
constexpr double kMaxLean = 0.87;  // [rad], 50°: beyond it a fingertip touches with its side
constexpr double kMaxStep = 1.2;   // [rad]: a steeper step between neighbors separates two parts

}  // namespace

Sample probe(const MeshQuery& link, const std::vector<MeshQuery>& others,
             const Eigen::Matrix3d& R_LS, const Vector2d& position_S, double top) {
  const Vector3d origin_L = R_LS * Vector3d(position_S.x(), position_S.y(), top);
  const Vector3d ray_L = -R_LS.col(2);
  Sample sample;
  const auto hit = link.first_hit(origin_L, ray_L);
  if (!hit) return sample;
  for (const MeshQuery& other : others) {
    const auto before = other.first_hit(origin_L, ray_L);
    if (before && before->distance < hit->distance - kFlatTolerance) return sample;
  }
  sample.is_hit = true;
  sample.point = R_LS.transpose() * hit->point;
  sample.normal = R_LS.transpose() * geometry::face_normal(link.mesh(), hit->face);
  return sample;
}

SearchBox search_box(const MeshQuery& link, const std::vector<MeshQuery>& others,
                     const Eigen::Matrix3d& R_LS, const PadSearch& search) {
  SearchBox result;
  const auto extend = [&](const MeshQuery& query, bool is_own) {
    for (const Vector3d& vertex : query.mesh().vertices) {
      const Vector3d v = R_LS.transpose() * vertex;
      result.top = std::max(result.top, v.z());
      if (is_own) result.box_S.extend(v);
    }
  };
  result.top = -std::numeric_limits<double>::infinity();
  extend(link, true);
  for (const MeshQuery& other : others) extend(other, false);
  result.top += 1e-3;  // anywhere above the surface
  if (search.center && search.reach > 0.0) {
    const Vector3d c = R_LS.transpose() * *search.center;
    for (int k = 0; k < 2; ++k) {
      result.box_S.min()[k] = std::max(result.box_S.min()[k], c[k] - search.reach);
      result.box_S.max()[k] = std::min(result.box_S.max()[k], c[k] + search.reach);
    }
  }
  return result;
}

RayGrid cast(const MeshQuery& link, const std::vector<MeshQuery>& others,
             const Eigen::Matrix3d& R_LS, const SearchBox& box) {
  RayGrid grid;
  const Vector2d size = box.box_S.sizes().head<2>();
  if (!(size.minCoeff() > 0.0)) return grid;
  grid.step = size.maxCoeff() / kNumRays;
  grid.nx = base::bounded_integer(std::ceil(size.x() / grid.step), 1, kNumRays + 1);
  grid.ny = base::bounded_integer(std::ceil(size.y() / grid.step), 1, kNumRays + 1);
  // Cells share the box evenly about its middle, so that a symmetric link has a symmetric grid.
  grid.corner = box.box_S.center().head<2>() - 0.5 * grid.step * Vector2d(grid.nx, grid.ny);
  for (int y = 0; y < grid.ny; ++y) {
    for (int x = 0; x < grid.nx; ++x) {
      grid.samples.push_back(probe(link, others, R_LS, grid.center(x, y), box.top));
    }
  }
  return grid;
}

std::vector<bool> facing_part(const RayGrid& grid, const std::optional<Vector2d>& center) {
  const std::size_t count = grid.samples.size();
  std::vector<std::optional<std::size_t>> part(count);
  std::vector<std::size_t> size;
  std::vector<double> distance;
  const auto faces = [&](std::size_t i) {
    return grid.samples[i].is_hit && grid.samples[i].normal.z() >= std::cos(kMaxLean);
  };
  for (int y0 = 0; y0 < grid.ny; ++y0) {
    for (int x0 = 0; x0 < grid.nx; ++x0) {
      if (part[grid.index(x0, y0)] || !faces(grid.index(x0, y0))) continue;
      const std::size_t own = size.size();
      size.push_back(0);
      distance.push_back(std::numeric_limits<double>::infinity());
      std::vector<std::pair<int, int>> open{{x0, y0}};
      part[grid.index(x0, y0)] = own;
      while (!open.empty()) {
        const auto [x, y] = open.back();
        open.pop_back();
        const std::size_t here = grid.index(x, y);
        ++size.back();
        if (center) {
          distance.back() =
              std::min(distance.back(), (grid.samples[here].point.head<2>() - *center).norm());
        }
        for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
          const int nx = x + dx;
          const int ny = y + dy;
          if (nx < 0 || ny < 0 || nx >= grid.nx || ny >= grid.ny) continue;
          const std::size_t there = grid.index(nx, ny);
          if (part[there] || !faces(there)) continue;
          const double rise =
              std::abs(grid.samples[there].point.z() - grid.samples[here].point.z());
          if (rise > grid.step * std::tan(kMaxStep)) continue;
          part[there] = own;
          open.emplace_back(nx, ny);
        }
      }
    }
  }
  std::optional<std::size_t> best;
  for (std::size_t p = 0; p < size.size(); ++p) {
    // Parts much smaller than the largest are ignored, even if they are nearest.
    const std::size_t largest = *std::max_element(size.begin(), size.end());
    if (10 * size[p] < largest) continue;
    if (!best) {
      best = p;
      continue;
    }
    const bool is_nearer = center && distance[p] < distance[*best] - grid.step;
    const bool is_farther = center && distance[p] > distance[*best] + grid.step;
    if (is_nearer || (!is_farther && size[p] > size[*best])) best = p;
  }
  std::vector<bool> cells(count, false);
  for (std::size_t i = 0; i < count; ++i) cells[i] = best && part[i] == best;
  return cells;
}

}  // namespace graspfit::hands::internal
