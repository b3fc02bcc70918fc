#include <algorithm>
#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "graspfit/base/as_index.hpp"
#include "graspfit/geometry/everyday_shapes.hpp"
#include "shapes/shape_dimensions.hpp"
#include "shapes/shape_limits.hpp"
#include "voxel/block.hpp"

namespace graspfit::geometry {
namespace {

using internal::require_below;
using internal::require_positive;

/// The planes of a grid of boxes along each axis, ascending.
using GridPlanes = std::array<std::vector<double>, 3>;

/// The boundary of the solid cells of a grid, every face of a cell being two triangles, so that
/// equal edges meet.
TriangleMesh boundary_of_cells(const GridPlanes& planes,
                               const std::function<bool(const Eigen::Vector3i&)>& is_solid_cell) {
  Eigen::Vector3i num_planes;
  for (int axis = 0; axis < 3; ++axis) num_planes[axis] = base::as_index<int>(planes[axis].size());
  const Eigen::Vector3i last_cell = num_planes.array() - 2;
  const auto is_solid = [&](const Eigen::Vector3i& cell) {
    return (cell.array() >= 0).all() && (cell.array() <= last_cell.array()).all() &&
           is_solid_cell(cell);
  };
  TriangleMesh mesh;
  std::vector<std::int32_t> index(num_planes.prod(), -1);
  const auto vertex = [&](const Eigen::Vector3i& p) {
    std::int32_t& i = index[p[0] + num_planes[0] * (p[1] + num_planes[1] * p[2])];
    if (i < 0) {
      i = base::as_index<std::int32_t>(mesh.vertices.size());
      mesh.vertices.emplace_back(planes[0][p[0]], planes[1][p[1]], planes[2][p[2]]);
    }
    return i;
  };
  internal::for_each_in_block({0, 0, 0}, last_cell, [&](const Eigen::Vector3i& cell) {
    if (!is_solid(cell)) return;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3i step = Eigen::Vector3i::Unit(axis);
      Eigen::Vector3i u = Eigen::Vector3i::Unit((axis + 1) % 3);
      Eigen::Vector3i v = Eigen::Vector3i::Unit((axis + 2) % 3);
      for (const int side : {0, 1}) {
        if (is_solid(cell + (2 * side - 1) * step)) continue;
        const Eigen::Vector3i low = cell + side * step;
        if (side == 0) std::swap(u, v);
        const std::int32_t a = vertex(low);
        const std::int32_t c = vertex(low + u + v);
        mesh.faces.push_back({a, vertex(low + u), c});
        mesh.faces.push_back({a, c, vertex(low + v)});
        if (side == 0) std::swap(u, v);
      }
    }
  });
  return mesh;
}

}  // namespace

void BinDimensions::validate() const { require_positive("bin", *this, internal::kBinFields); }

TriangleMesh bin(const BinDimensions& d) {
  d.validate();
  const auto walls = [&](double inner_extent) {
    const double inner = 0.5 * inner_extent;
    const double outer = inner + d.wall_thickness;
    return std::vector<double>{-outer, -inner, inner, outer};
  };
  const GridPlanes planes = {
      walls(d.inner_length), walls(d.inner_width), {-d.wall_thickness, 0.0, d.inner_height}};
  return boundary_of_cells(planes, [](const Eigen::Vector3i& cell) {
    return cell[0] != 1 || cell[1] != 1 || cell[2] == 0;
  });
}

void TableDimensions::validate() const {
  const char* const shape = "table";
  require_positive(shape, *this, internal::kTableFields);
  require_below(shape, "top_thickness", top_thickness, height, "height");
  require_below(shape, "leg_width", leg_width, 0.5 * std::min(length, width) - leg_inset,
                "what leg_inset leaves of half of length and of width");
}

TriangleMesh table(const TableDimensions& d) {
  d.validate();
  const auto legs = [&](double extent) {
    const double outer = 0.5 * extent;
    const double leg = outer - d.leg_inset;
    const double inner = leg - d.leg_width;
    return std::vector<double>{-outer, -leg, -inner, inner, leg, outer};
  };
  const GridPlanes planes = {
      legs(d.length), legs(d.width), {0.0, d.height - d.top_thickness, d.height}};
  return boundary_of_cells(planes, [](const Eigen::Vector3i& cell) {
    return cell[2] == 1 || (cell[0] % 2 == 1 && cell[1] % 2 == 1);
  });
}

}  // namespace graspfit::geometry
