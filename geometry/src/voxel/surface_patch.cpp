#include "graspfit/geometry/surface_patch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include "exact/predicates.hpp"
#include "graspfit/base/errors.hpp"
#include "query/box_tree.hpp"
#include "voxel/triangle_clip.hpp"

namespace graspfit::geometry {
namespace {

using internal::CutEdge;
using internal::CutPolygon;
using internal::TriangleCutter;

constexpr int kOutside = -1;  // Cell of a coordinate below the first plane.

// Vertices of a face lie apart in memory: they are fetched this many faces ahead.
constexpr std::size_t kAhead = 16;

// The least i with x < plane(i + 1): the voxel that holds x, one in a plane being in the higher.
// Exact, since it ends by comparing with the planes themselves. −1 and counts stand for all beyond.
int cell_of(const VoxelLattice& lattice, int axis, double x) {
  const int count = lattice.counts[axis];
  const double quotient = (x - lattice.origin[axis]) / lattice.voxel_size;
  if (!(quotient > -2.0 && quotient < count + 2.0)) return quotient > 0.0 ? count : kOutside;
  int i = static_cast<int>(quotient);
  while (i > kOutside && x < lattice.plane(axis, i)) --i;
  while (i < count && x >= lattice.plane(axis, i + 1)) ++i;
  return i;
}

// Twice the cell of a vertex on each axis, plus one unless it lies in the cell's lower plane.
using VertexCode = std::array<int, 3>;

std::vector<VertexCode> vertex_codes(const TriangleMesh& mesh, const VoxelLattice& lattice) {
  std::vector<VertexCode> codes(mesh.vertices.size());
  for (std::size_t i = 0; i < codes.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double x = mesh.vertices[i][axis];
      const int cell = cell_of(lattice, axis, x);
      codes[i][axis] = 2 * cell + (x == lattice.plane(axis, cell) ? 0 : 1);
    }
  }
  return codes;
}

// Area and unit normal of a face.
struct FaceMeasure {
  Eigen::Vector3d normal;
  double area = 0.0;  // Zero if and only if its corners are collinear.
};

inline FaceMeasure face_measure(const std::array<Eigen::Vector3d, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  const Eigen::Vector3d area = internal::accurate_vector_area(a, b, c);
  FaceMeasure result;
  const double squared = area.squaredNorm();
  if (squared > 0x1p-900 && squared < 0x1p900) {
    result.area = std::sqrt(squared);
    result.normal = area * (1.0 / result.area);
  } else {
    result.area = area.stableNorm();
    result.normal = area.stableNormalized();
  }
  return result;
}

// What a face leaves in a voxel.
struct Piece {
  Eigen::Vector3d centroid;
  Eigen::Vector3d normal;
  double area;
  std::int32_t first_corner;  // Of `Layer::corners`; whole faces have none there.
  float squared_radius;  // Of a ball about the centroid that holds it; rounded, see kRadiusRoom.
  std::int32_t face;
};

// A piece by its place in the lists of its layer.
struct PieceName {
  std::int32_t cell;  // Index of its voxel in the layer, x fastest.
  std::int32_t face;
  std::int32_t piece;
};

// The pieces in one layer of voxels across z. Layers are filled from below and done with one after
// the other, so that what is worked on stays in the processor's caches, and memory is used again.
struct Layer {
  std::vector<Piece> pieces;
  std::vector<Eigen::Vector3d> corners;
  std::vector<PieceName> names;  // Once complete, ascending by voxel, then face.

  bool is_whole(std::int32_t piece) const { return end_of(piece) == pieces[piece].first_corner; }
  // Of a piece that is not a whole face.
  std::span<const Eigen::Vector3d> polygon(std::int32_t piece) const {
    return {corners.data() + pieces[piece].first_corner, corners.data() + end_of(piece)};
  }

  void clear() {
    pieces.clear();
    corners.clear();
    names.clear();
  }

 private:
  std::int32_t end_of(std::int32_t piece) const {
    const auto next = static_cast<std::size_t>(piece) + 1;
    return next < pieces.size() ? pieces[next].first_corner
                                : static_cast<std::int32_t>(corners.size());
  }
};

// Orders names by voxel and face: stable passes over the digits of the face, then of the voxel,
// which take a fraction of the time of comparing.
void sort_names(std::vector<PieceName>& names, std::vector<PieceName>& scratch,
                std::int32_t num_cells, std::int32_t num_faces) {
  constexpr int kDigitBits = 11;
  scratch.resize(names.size());
  const auto order_by = [&](std::int32_t PieceName::*key, std::int32_t num_keys) {
    for (int shift = 0; (std::int64_t{num_keys - 1} >> shift) > 0; shift += kDigitBits) {
      const auto digit = [&](const PieceName& name) {
        return static_cast<std::size_t>(name.*key >> shift) & ((1 << kDigitBits) - 1);
      };
      std::array<std::uint32_t, (1 << kDigitBits) + 1> begin{};
      for (const PieceName& name : names) ++begin[digit(name) + 1];
      std::partial_sum(begin.begin(), begin.end(), begin.begin());
      for (const PieceName& name : names) scratch[begin[digit(name)]++] = name;
      std::swap(names, scratch);
    }
  };
  order_by(&PieceName::face, num_faces);
  order_by(&PieceName::cell, num_cells);
}

Eigen::Vector3d centroid_of(const std::array<Eigen::Vector3d, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  return a + ((b - a) + (c - a)) / 3.0;
}

// Cuts the faces of a mesh at the planes of a lattice, into layers along z, each of these along y,
// each of those along x.
class VoxelCutter {
 public:
  VoxelCutter(const TriangleMesh& mesh, const VoxelLattice& lattice)
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
  }

  // Calls `take(layer, first voxel)` for every layer that holds pieces, from below.
  void run(const std::function<void(const Layer&, std::int64_t)>& take) {
    codes_ = vertex_codes(mesh_, lattice_);
    const auto num_layers = static_cast<std::size_t>(lattice_.counts[2]);
    layers_.resize(num_layers);

    // The faces by the layer in which they begin, ascending in each.
    std::vector<std::size_t> begin(num_layers + 2, 0);
    for (std::size_t face = 0; face < mesh_.faces.size(); ++face) {
      find_cells(static_cast<std::int32_t>(face));
      ++begin[first_[2] + 2];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::int32_t> faces(mesh_.faces.size());
    for (std::size_t face = 0; face < mesh_.faces.size(); ++face) {
      const Face& f = mesh_.faces[face];
      const int low = std::min({codes_[f[0]][2], codes_[f[1]][2], codes_[f[2]][2]});
      faces[begin[(low >> 1) + 1]++] = static_cast<std::int32_t>(face);
    }

    const std::int32_t num_cells = lattice_.counts[0] * lattice_.counts[1];
    const auto num_faces = static_cast<std::int32_t>(mesh_.faces.size());
    std::vector<PieceName> scratch;
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
      Layer& layer = layers_[k];
      if (layer.names.empty()) continue;
      sort_names(layer.names, scratch, num_cells, num_faces);
      take(layer, static_cast<std::int64_t>(k) * num_cells);
      layer.clear();
      spare_.push_back(std::move(layer));
    }
  }

 private:
  struct Level {
    CutPolygon rest;   // Not yet cut along this axis.
    CutPolygon piece;  // In one slab of this axis and the ones before.
    CutPolygon other;
  };

  void find_cells(std::int32_t face) {
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
        throw base::InvalidInput("face " + std::to_string(face) +
                                 " of the mesh leaves the lattice");
      }
    }
  }

  void cut(std::int32_t face) {
    find_cells(face);
    const Face& f = mesh_.faces[face];
    const std::array<Eigen::Vector3d, 3> triangle = {mesh_.vertices[f[0]], mesh_.vertices[f[1]],
                                                     mesh_.vertices[f[2]]};
    measure_ = face_measure(triangle);
    if (measure_.area == 0.0) return;
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
  void cut_along(int first, int last) {
    Level& level = levels_[kAxis];
    for (int i = first; i <= last; ++i) {
      if (i == last) {
        std::swap(level.piece, level.rest);
        level.rest.clear();
      } else {
        const std::uint32_t line =
            first_line_[kAxis] + static_cast<std::uint32_t>(i - first_[kAxis]);
        cutter_.split(level.rest, line, TriangleCutter::InPlane::Outside, level.piece,
                      &level.other);
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
  // exact decision is skipped. One plane is as quickly tried as bounded.
  template <int kAxis>
  void cut_narrowed() {
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

  void add_whole(const std::array<Eigen::Vector3d, 3>& triangle) {
    Layer& layer = layer_of_cell();
    const Eigen::Vector3d centroid = centroid_of(triangle);
    double squared_radius = 0.0;
    for (const Eigen::Vector3d& corner : triangle) {
      squared_radius = std::max(squared_radius, (corner - centroid).squaredNorm());
    }
    add(layer, measure_.area, centroid, layer.corners.size(), squared_radius);
  }

  void add_cut(const CutPolygon& polygon) {
    Layer& layer = layer_of_cell();
    const internal::CutMeasure measure = cutter_.measure(polygon);
    const std::size_t first = layer.corners.size();
    double squared_radius = 0.0;
    for (const CutEdge& of : polygon) {
      const Eigen::Vector3d& corner = cutter_.corner(of).point;
      squared_radius = std::max(squared_radius, (corner - measure.centroid).squaredNorm());
      layer.corners.push_back(corner);
    }
    add(layer, measure.fraction * measure_.area, measure.centroid, first, squared_radius);
  }

  void add(Layer& layer, double area, const Eigen::Vector3d& centroid, std::size_t first_corner,
           double squared_radius) {
    layer.names.push_back({cell_[0] + lattice_.counts[0] * cell_[1], face_,
                           static_cast<std::int32_t>(layer.pieces.size())});
    layer.pieces.push_back({centroid, measure_.normal, area,
                            static_cast<std::int32_t>(first_corner),
                            static_cast<float>(squared_radius), face_});
  }

  Layer& layer_of_cell() {
    Layer& layer = layers_[cell_[2]];
    if (layer.names.empty() && !spare_.empty()) {
      layer = std::move(spare_.back());
      spare_.pop_back();
    }
    return layer;
  }

  const TriangleMesh& mesh_;
  const VoxelLattice& lattice_;
  std::vector<VertexCode> codes_;
  std::vector<Layer> layers_;
  std::vector<Layer> spare_;  // Cleared ones, for their memory.
  TriangleCutter cutter_;
  std::array<Level, 3> levels_;
  std::array<int, 3> first_;  // Cells of the face at hand,
  std::array<int, 3> last_;
  std::array<std::uint32_t, 3> first_line_;  // name of the plane above the first of them,
  std::array<int, 3> cell_;                  // and of the piece at hand.
  std::int32_t face_ = -1;
  FaceMeasure measure_;
};

// Squared distances within this of each other, relatively, are not told apart by the rounded radius
// of a piece (a float) and the rounding of the distances.
constexpr double kRadiusRoom = 1.0 + 1e-6;

// The point of some pieces nearest to `point`; of equally near ones that of the first. A piece lies
// in a ball about its centroid, so that most need not be looked at once a near one is known.
class PatchProjection {
 public:
  PatchProjection(const TriangleMesh& mesh, const Layer& all, const Eigen::Vector3d& point)
      : mesh_(mesh), all_(all), point_(point) {}

  Eigen::Vector3d nearest(std::span<const PieceName> names) {
    std::int32_t start = names.front().piece;
    double least = std::numeric_limits<double>::infinity();
    for (const PieceName& name : names) {
      const double squared = (all_.pieces[name.piece].centroid - point_).squaredNorm();
      if (squared < least) {
        least = squared;
        start = name.piece;
      }
    }
    look(start);
    for (const PieceName& name : names) {
      if (name.piece == start) continue;
      // Too far if the centroid is farther than radius and best distance together. A radius too
      // small or too large for a float says nothing.
      const Piece& piece = all_.pieces[name.piece];
      const double r_squared = piece.squared_radius;
      const double reach = r_squared + squared_ + 2.0 * std::sqrt(r_squared * squared_);
      if (r_squared > kLeastRadius && (piece.centroid - point_).squaredNorm() > reach * kRadiusRoom)
        continue;
      look(name.piece);
    }
    return best_;
  }

 private:
  static constexpr float kLeastRadius = 0x1p-120F;

  void look(std::int32_t piece) {
    if (all_.is_whole(piece)) {
      look(piece, corners(mesh_, static_cast<std::size_t>(all_.pieces[piece].face)));
      return;
    }
    const auto polygon = all_.polygon(piece);
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      look(piece, {polygon[0], polygon[i - 1], polygon[i]});
    }
  }

  void look(std::int32_t piece, const std::array<Eigen::Vector3d, 3>& triangle) {
    const Eigen::Vector3d candidate = internal::closest_on_triangle(point_, triangle);
    const double squared = (candidate - point_).squaredNorm();
    if (piece_ < 0 || squared < squared_ ||
        (squared == squared_ && all_.pieces[piece].face < all_.pieces[piece_].face)) {
      squared_ = squared;
      piece_ = piece;
      best_ = candidate;
    }
  }

  const TriangleMesh& mesh_;
  const Layer& all_;
  const Eigen::Vector3d& point_;
  Eigen::Vector3d best_ = point_;
  double squared_ = std::numeric_limits<double>::infinity();
  std::int32_t piece_ = -1;
};

// About as many as there will be patches: a surface of area A meets 1.5 A / h² voxels of edge h on
// average over its directions; from every 16th face, with an eighth to spare. Where sheets lie
// close, voxels share them: no more than the surface of a box of the lattice's size would have.
std::size_t expected_patches(const TriangleMesh& mesh, const VoxelLattice& lattice) {
  constexpr std::size_t kStride = 16;
  double area = 0.0;
  for (std::size_t face = 0; face < mesh.faces.size(); face += kStride) {
    area += kStride * vector_area(mesh, face).norm();
  }
  const Eigen::Vector3d n = lattice.counts.cast<double>();
  const double most = 2.0 * (n[0] * n[1] + n[1] * n[2] + n[2] * n[0]);
  const double expected = 1.125 * 1.5 * area / (lattice.voxel_size * lattice.voxel_size);
  if (!std::isfinite(expected)) return 0;  // So small that squares of lengths vanish.
  return static_cast<std::size_t>(std::min(expected, most));
}

// The patch of the pieces of one voxel.
SurfacePatch patch_of(const TriangleMesh& mesh, const Layer& layer,
                      std::span<const PieceName> names, const SurfacePatchOptions& options) {
  SurfacePatch patch;
  patch.faces.reserve(names.size());
  // Relative to the first, so that far from the origin no digits are lost.
  const Eigen::Vector3d reference = layer.pieces[names.front().piece].centroid;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum_of_centroids = Eigen::Vector3d::Zero();
  Eigen::Vector3d vector_area = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum_of_normals = Eigen::Vector3d::Zero();
  for (const PieceName& name : names) {
    const Piece& piece = layer.pieces[name.piece];
    const Eigen::Vector3d from_reference = piece.centroid - reference;
    patch.area += piece.area;
    moment += piece.area * from_reference;
    sum_of_centroids += from_reference;
    vector_area += piece.area * piece.normal;
    sum_of_normals += piece.normal;
    patch.faces.push_back(piece.face);
  }
  const auto num_pieces = static_cast<double>(names.size());
  patch.area_centroid = reference + moment / patch.area;
  patch.area_weighted_normal = vector_area / patch.area;
  patch.plain_normal = sum_of_normals / num_pieces;
  const bool is_weighted = options.averaging == PatchAveraging::AreaWeighted;
  const Eigen::Vector3d mean =
      is_weighted ? patch.area_centroid : (reference + sum_of_centroids / num_pieces).eval();
  patch.centroid = PatchProjection(mesh, layer, mean).nearest(names);
  const Eigen::Vector3d& normal = is_weighted ? patch.area_weighted_normal : patch.plain_normal;
  const double length = normal.norm();
  patch.has_normal = length >= 0.1;
  patch.outward_normal =
      patch.has_normal ? (normal / length).eval() : Eigen::Vector3d::Zero().eval();
  return patch;
}

VoxelPiece voxel_piece(const TriangleMesh& mesh, const Layer& layer, const PieceName& name,
                       std::int64_t first_voxel) {
  const Piece& piece = layer.pieces[name.piece];
  VoxelPiece result;
  result.voxel = first_voxel + name.cell;
  result.piece.area = piece.area;
  result.piece.centroid = piece.centroid;
  result.piece.face = piece.face;
  if (layer.is_whole(name.piece)) {
    const auto triangle = corners(mesh, static_cast<std::size_t>(piece.face));
    result.piece.polygon.assign(triangle.begin(), triangle.end());
  } else {
    const auto polygon = layer.polygon(name.piece);
    result.piece.polygon.assign(polygon.begin(), polygon.end());
  }
  return result;
}

}  // namespace

std::vector<SurfacePatch> surface_patches(const TriangleMesh& mesh, const VoxelLattice& lattice,
                                          const SurfacePatchOptions& options) {
  VoxelCutter cutter(mesh, lattice);
  std::vector<SurfacePatch> patches;
  cutter.run([&](const Layer& layer, std::int64_t first_voxel) {
    if (patches.empty()) patches.reserve(expected_patches(mesh, lattice));
    const std::span<const PieceName> names = layer.names;
    for (std::size_t begin = 0, end = 0; begin < names.size(); begin = end) {
      while (end < names.size() && names[end].cell == names[begin].cell) ++end;
      patches.push_back(patch_of(mesh, layer, names.subspan(begin, end - begin), options));
      patches.back().voxel = first_voxel + names[begin].cell;
    }
  });
  return patches;
}

std::vector<VoxelPiece> clip_by_voxels(const TriangleMesh& mesh, const VoxelLattice& lattice) {
  VoxelCutter cutter(mesh, lattice);
  std::vector<VoxelPiece> pieces;
  cutter.run([&](const Layer& layer, std::int64_t first_voxel) {
    for (const PieceName& name : layer.names) {
      pieces.push_back(voxel_piece(mesh, layer, name, first_voxel));
    }
  });
  return pieces;
}

}  // namespace graspfit::geometry
