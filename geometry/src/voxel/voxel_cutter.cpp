#include "voxel/voxel_cutter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "exact/predicates.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "mesh/input_check.hpp"

namespace graspfit::geometry::internal {
namespace {

constexpr int kOutside = -1;  // Cell of a coordinate below the first plane.

// Vertices of a face lie apart in memory: they are fetched this many faces ahead.
constexpr std::size_t kAhead = 16;

// The least i with x < plane(i + 1): the voxel that holds x, where an x in a plane belongs to the
// higher voxel. Exact, since the search ends by comparing with the planes themselves. −1 and counts
// stand for all x beyond the lattice.
int cell_of(const VoxelLattice& lattice, int axis, double x) {
  const int count = lattice.counts[axis];
  const double quotient = (x - lattice.origin[axis]) / lattice.voxel_size;
  if (!(quotient > -2.0 && quotient < count + 2.0)) return quotient > 0.0 ? count : kOutside;
  int i = static_cast<int>(quotient);
  while (i > kOutside && x < lattice.plane(axis, i)) --i;
  while (i < count && x >= lattice.plane(axis, i + 1)) ++i;
  return i;
}

// Orders names by voxel and face: stable passes over the digits of the face, then of the voxel,
// which take a fraction of the time of comparing.
void sort_names(std::vector<CutPieceName>& names, std::vector<CutPieceName>& scratch,
                std::int32_t num_cells, std::int32_t num_faces) {
  constexpr int kDigitBits = 11;
  scratch.resize(names.size());
  const auto order_by = [&](std::int32_t CutPieceName::*key, std::int32_t num_keys) {
    for (int shift = 0; (std::int64_t{num_keys - 1} >> shift) > 0; shift += kDigitBits) {
      const auto digit = [&](const CutPieceName& name) {
        return static_cast<std::size_t>(name.*key >> shift) & ((1 << kDigitBits) - 1);
      };
      std::array<std::uint32_t, (1 << kDigitBits) + 1> begin{};
      for (const CutPieceName& name : names) ++begin[digit(name) + 1];
      std::partial_sum(begin.begin(), begin.end(), begin.begin());
      for (const CutPieceName& name : names) scratch[begin[digit(name)]++] = name;
      std::swap(names, scratch);
    }
  };
  order_by(&CutPieceName::face, num_faces);
  order_by(&CutPieceName::cell, num_cells);
}

[[noreturn]] void refuse(std::int32_t face) {
  throw base::InvalidInput("face " + std::to_string(face) + " of the mesh leaves the lattice");
}

Eigen::Vector3d centroid_of(const std::array<Eigen::Vector3d, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  return a + ((b - a) + (c - a)) / 3.0;
}

}  // namespace

VoxelCutter::VoxelCutter(const TriangleMesh& mesh, const VoxelLattice& lattice)
    : mesh_(mesh), lattice_(lattice) {
  if (!(lattice.voxel_size > 0.0) || !std::isfinite(lattice.voxel_size) ||
      (lattice.counts.array() < 1).any()) {
    throw base::InvalidInput("the lattice is empty");
  }
  if (lattice.counts.cast<double>().prod() > std::numeric_limits<std::int32_t>::max()) {
    throw base::InvalidInput("the lattice has more than 2^31 - 1 voxels");
  }
  if (lattice.counts.maxCoeff() > 1 << 29) {
    throw base::InvalidInput("the lattice has more than 2^29 voxels along an axis");
  }
  require_usable(mesh, "voxels");
}

void VoxelCutter::run(const std::function<void(const CutLayer&, std::int64_t)>& take) {
  codes_ = vertex_codes();
  const auto num_layers = static_cast<std::size_t>(lattice_.counts[2]);
  layers_.resize(num_layers);

  // The faces by the layer in which they begin, ascending in each.
  std::vector<std::int32_t> layer_of(mesh_.faces.size());
  std::vector<std::size_t> begin(num_layers + 2, 0);
  for (std::int32_t face = 0; face < std::ssize(mesh_.faces); ++face) {
    const Face& f = mesh_.faces[face];
    const int low = std::min({codes_[f[0]][2], codes_[f[1]][2], codes_[f[2]][2]});
    if (low < 0 || low >= 2 * lattice_.counts[2]) refuse(face);
    layer_of[face] = low >> 1;
    ++begin[layer_of[face] + 2];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::int32_t> faces(mesh_.faces.size());
  for (std::int32_t face = 0; face < std::ssize(mesh_.faces); ++face) {
    faces[begin[layer_of[face] + 1]++] = face;
  }

  const std::int32_t num_cells = lattice_.counts[0] * lattice_.counts[1];
  const auto num_faces = base::as_index<std::int32_t>(mesh_.faces.size());
  std::vector<CutPieceName> scratch;
  for (std::size_t k = 0; k < num_layers; ++k) {
    for (std::size_t i = begin[k]; i < begin[k + 1]; ++i) {
      if (i + 2 * kAhead < faces.size()) __builtin_prefetch(&mesh_.faces[faces[i + 2 * kAhead]]);
      if (i + kAhead < faces.size()) {
        for (const std::int32_t vertex : mesh_.faces[faces[i + kAhead]]) {
          __builtin_prefetch(&codes_[vertex]);
          __builtin_prefetch(&mesh_.vertices[vertex]);
        }
      }
      cut(faces[i]);
    }
    CutLayer& layer = layers_[k];
    if (layer.names.empty()) continue;
    sort_names(layer.names, scratch, num_cells, num_faces);
    take(layer, static_cast<std::int64_t>(k) * num_cells);
    layer.clear();
    spare_.push_back(std::move(layer));
  }
}

void VoxelCutter::find_cells(std::int32_t face) {
  const Face& f = mesh_.faces[face];
  const VertexCode& a = codes_[f[0]];
  const VertexCode& b = codes_[f[1]];
  const VertexCode& c = codes_[f[2]];
  for (int axis = 0; axis < 3; ++axis) {
    const int low = std::min({a[axis], b[axis], c[axis]});
    const int high = std::max({a[axis], b[axis], c[axis]});
    // A triangle that ends at a plane has no area beyond it, unless it lies in the plane.
    first_[axis] = low >> 1;
    last_[axis] = std::max(first_[axis], (high - 1) >> 1);
    if (low < 0 || last_[axis] >= lattice_.counts[axis]) {
      refuse(face);
    }
  }
}

void VoxelCutter::measure(const std::array<Eigen::Vector3d, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  const Eigen::Vector3d vector_area = accurate_vector_area(a, b, c);
  const double squared = vector_area.squaredNorm();
  if (squared > 0x1p-900 && squared < 0x1p900) {
    area_ = std::sqrt(squared);
    normal_ = vector_area * (1.0 / area_);
  } else {
    area_ = vector_area.stableNorm();
    normal_ = vector_area.stableNormalized();
  }
}

void VoxelCutter::cut(std::int32_t face) {
  find_cells(face);
  const Face& f = mesh_.faces[face];
  const std::array<Eigen::Vector3d, 3> triangle = {mesh_.vertices[f[0]], mesh_.vertices[f[1]],
                                                   mesh_.vertices[f[2]]};
  measure(triangle);
  if (area_ == 0.0) return;
  face_ = face;
  if (first_ == last_) {
    cell_ = first_;
    add_whole(triangle);
    return;
  }
  cutter_.reset(triangle);
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = first_[axis]; i < last_[axis]; ++i) {
      const std::uint32_t line = cutter_.add_axis_plane(axis, lattice_.plane(axis, i + 1));
      if (i == first_[axis]) first_line_[axis] = line;
    }
  }
  cutter_.whole(levels_[2].rest);
  cut_along<2>(first_[2], last_[2]);
}

// Cuts levels_[kAxis].rest, which is known to lie in cells first…last of this axis, into slabs.
template <int kAxis>
void VoxelCutter::cut_along(int first, int last) {
  Level& level = levels_[kAxis];
  for (int i = first; i <= last; ++i) {
    if (i == last) {
      std::swap(level.piece, level.rest);
      level.rest.clear();
    } else {
      const std::uint32_t line = first_line_[kAxis] + static_cast<std::uint32_t>(i - first_[kAxis]);
      cutter_.split(level.rest, line, TriangleCutter::InPlane::Outside, level.piece, &level.other);
      std::swap(level.rest, level.other);
    }
    if (!level.piece.empty()) {
      cell_[kAxis] = i;
      if constexpr (kAxis == 0) {
        add_cut(level.piece);
      } else {
        std::swap(levels_[kAxis - 1].rest, level.piece);
        cut_narrowed<kAxis - 1>();
      }
    }
    if (level.rest.empty()) break;
  }
}

// Narrows the cells of the axis to those that the polygon may reach: outer bounds, so that no
// exact decision is skipped. Cutting by one plane is as quick as bounding the polygon.
template <int kAxis>
void VoxelCutter::cut_narrowed() {
  int first = first_[kAxis];
  int last = last_[kAxis];
  if (last - first > 1) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const CutEdge& of : levels_[kAxis].rest) {
      low = std::min(low, cutter_.corner(of).point[kAxis]);
      high = std::max(high, cutter_.corner(of).point[kAxis]);
    }
    first = std::max(first, cell_of(lattice_, kAxis, low - cutter_.slack(kAxis)));
    last = std::min(last, cell_of(lattice_, kAxis, high + cutter_.slack(kAxis)));
  }
  cut_along<kAxis>(first, last);
}

void VoxelCutter::add_whole(const std::array<Eigen::Vector3d, 3>& triangle) {
  CutLayer& layer = layer_of_cell();
  const Eigen::Vector3d centroid = centroid_of(triangle);
  double squared_radius = 0.0;
  for (const Eigen::Vector3d& corner : triangle) {
    squared_radius = std::max(squared_radius, (corner - centroid).squaredNorm());
  }
  add(layer, area_, centroid, layer.corners.size(), squared_radius);
}

void VoxelCutter::add_cut(const CutPolygon& polygon) {
  CutLayer& layer = layer_of_cell();
  const CutMeasure measure = cutter_.measure(polygon);
  const std::size_t first = layer.corners.size();
  double squared_radius = 0.0;
  for (const CutEdge& of : polygon) {
    const Eigen::Vector3d& corner = cutter_.corner(of).point;
    squared_radius = std::max(squared_radius, (corner - measure.centroid).squaredNorm());
    layer.corners.push_back(corner);
  }
  add(layer, measure.fraction * area_, measure.centroid, first, squared_radius);
}

void VoxelCutter::add(CutLayer& layer, double area, const Eigen::Vector3d& centroid,
                      std::size_t first_corner, double squared_radius) {
  layer.names.push_back({cell_[0] + lattice_.counts[0] * cell_[1], face_,
                         base::as_index<std::int32_t>(layer.pieces.size())});
  layer.pieces.push_back({centroid, normal_, area, static_cast<std::int32_t>(first_corner),
                          static_cast<float>(squared_radius), face_});
}

CutLayer& VoxelCutter::layer_of_cell() {
  CutLayer& layer = layers_[cell_[2]];
  if (layer.names.empty() && !spare_.empty()) {
    layer = std::move(spare_.back());
    spare_.pop_back();
  }
  return layer;
}

std::vector<VoxelCutter::VertexCode> VoxelCutter::vertex_codes() const {
  std::vector<VertexCode> codes(mesh_.vertices.size());
  for (std::size_t i = 0; i < codes.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double x = mesh_.vertices[i][axis];
      const int cell = cell_of(lattice_, axis, x);
      codes[i][axis] = 2 * cell + (x == lattice_.plane(axis, cell) ? 0 : 1);
    }
  }
  return codes;
}

}  // namespace graspfit::geometry::internal
