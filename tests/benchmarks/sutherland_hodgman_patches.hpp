#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "graspfit/geometry/surface_patch.hpp"

namespace graspfit::testing {

/// Returns the point of a closed triangle nearest to `p`, by the Voronoi regions [Ericson 2005,
/// 5.1.5].
inline Eigen::Vector3d nearest_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                           const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  }
  const double scale = 1.0 / (va + vb + vc);
  return a + vb * scale * ab + vc * scale * ac;
}

/// Gives what `surface_patches` gives, by Sutherland and Hodgman's clipping in the given
/// arithmetic, as the benchmark's reference. Every face is cut into slabs along z, each slab along
/// y, each of those along x. What is not arithmetic is as quick as the library's and done in the
/// same way (one pass over vertices for their cells, faces within one voxel as they are, one layer
/// of voxels after the other in memory that is used again, sorting by digits, projection with balls
/// that exclude far pieces, memory fetched ahead).
///
/// `Arithmetic` has
///   Point, Plane;
///   Point point(const Eigen::Vector3d&);  Eigen::Vector3d to_double(const Point&);
///   Plane plane(int axis, double coordinate);
///   bool is_below(const Point&, const Plane&);            coordinate < plane
///   Point meet(const Point& p, const Point& q, const Plane&);
///   void measure(const Point* polygon, int n, double& area, Eigen::Vector3d& centroid);
///   static constexpr bool kMeasuresWholeFaces;            by `measure`, too
template <typename Arithmetic>
class SutherlandHodgmanPatches {
 public:
  SutherlandHodgmanPatches(const geometry::TriangleMesh& mesh,
                           const geometry::VoxelLattice& lattice)
      : mesh_(mesh), lattice_(lattice) {}

  std::vector<geometry::SurfacePatch> run() {
    const auto num_faces = static_cast<std::int32_t>(mesh_.faces.size());
    const auto num_layers = static_cast<std::size_t>(lattice_.counts[2]);
    find_vertex_cells();
    layers_.resize(num_layers);
    std::vector<std::size_t> begin(num_layers + 2, 0);
    double area = 0.0;
    for (std::int32_t face = 0; face < num_faces; ++face) {
      find_cells(face);
      ++begin[first_[2] + 2];
      if (face % 16 == 0) {
        const geometry::Face& f = mesh_.faces[face];
        area += 8.0 * (mesh_.vertices[f[1]] - mesh_.vertices[f[0]])
                          .cross(mesh_.vertices[f[2]] - mesh_.vertices[f[0]])
                          .norm();
      }
    }
    for (std::size_t k = 1; k < begin.size(); ++k) begin[k] += begin[k - 1];
    std::vector<std::int32_t> faces(mesh_.faces.size());
    for (std::int32_t face = 0; face < num_faces; ++face) {
      const geometry::Face& f = mesh_.faces[face];
      const int low = std::min({cells_[f[0]][2], cells_[f[1]][2], cells_[f[2]][2]});
      faces[begin[low + 1]++] = face;
    }
    patches_.reserve(
        static_cast<std::size_t>(1.7 * area / (lattice_.voxel_size * lattice_.voxel_size)));
    for (std::size_t k = 0; k < num_layers; ++k) {
      for (std::size_t i = begin[k]; i < begin[k + 1]; ++i) {
        if (i + 2 * kAhead < faces.size()) __builtin_prefetch(&mesh_.faces[faces[i + 2 * kAhead]]);
        if (i + kAhead < faces.size()) {
          for (const std::int32_t v : mesh_.faces[faces[i + kAhead]]) {
            __builtin_prefetch(&cells_[v]);
            __builtin_prefetch(&mesh_.vertices[v]);
          }
        }
        cut(faces[i]);
      }
      if (layers_[k].names.empty()) continue;
      sort(layers_[k].names);
      average(layers_[k], k);
      layers_[k].clear();
      spare_.push_back(std::move(layers_[k]));
    }
    return std::move(patches_);
  }

 private:
  using Point = typename Arithmetic::Point;
  using Plane = typename Arithmetic::Plane;

  // A triangle cut by six planes has nine corners at most, and one more where rounding adds it.
  struct Polygon {
    std::array<Point, 12> corners;
    int n = 0;
    void push(const Point& p) {
      if (n < 12) corners[n++] = p;
    }
  };
  struct Name {
    std::int32_t cell;
    std::int32_t face;
    std::int32_t piece;
  };
  struct Piece {
    Eigen::Vector3d centroid;
    Eigen::Vector3d normal;
    double area;
    std::int32_t first_corner;
    std::int32_t past_corner;
    float squared_radius;
    std::int32_t face;
  };
  struct Layer {
    std::vector<Piece> pieces;
    std::vector<Eigen::Vector3d> corners;
    std::vector<Name> names;
    void clear() {
      pieces.clear();
      corners.clear();
      names.clear();
    }
  };

  void find_vertex_cells() {
    const double scale = 1.0 / lattice_.voxel_size;
    cells_.resize(mesh_.vertices.size());
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      cells_[i] = ((mesh_.vertices[i] - lattice_.origin) * scale).array().floor().cast<int>();
    }
  }

  void cut(std::int32_t face) {
    find_cells(face);
    const geometry::Face& f = mesh_.faces[face];
    const Eigen::Vector3d &a = mesh_.vertices[f[0]], &b = mesh_.vertices[f[1]],
                          &c = mesh_.vertices[f[2]];
    const Eigen::Vector3d doubled = (b - a).cross(c - a);
    const double length = doubled.norm();
    if (length == 0.0) return;
    face_ = face;
    normal_ = doubled / length;
    if (first_ == last_) {
      cell_ = first_;
      double area = 0.5 * length;
      Eigen::Vector3d centroid = (a + b + c) / 3.0;
      if constexpr (Arithmetic::kMeasuresWholeFaces) {
        const Point corners[] = {arithmetic_.point(a), arithmetic_.point(b), arithmetic_.point(c)};
        arithmetic_.measure(corners, 3, area, centroid);
      }
      const double squared = std::max({(a - centroid).squaredNorm(), (b - centroid).squaredNorm(),
                                       (c - centroid).squaredNorm()});
      Layer& layer = layer_of_cell();
      add(layer, area, centroid, layer.corners.size(), squared);
      return;
    }
    whole_.n = 0;
    for (const Eigen::Vector3d* const p : {&a, &b, &c}) whole_.push(arithmetic_.point(*p));
    cut_along<2>(&whole_, first_[2], last_[2]);
  }

  void find_cells(std::int32_t face) {
    const geometry::Face& f = mesh_.faces[face];
    const Eigen::Vector3i &a = cells_[f[0]], &b = cells_[f[1]], &c = cells_[f[2]];
    first_ = a.cwiseMin(b).cwiseMin(c);
    last_ = a.cwiseMax(b).cwiseMax(c);
  }

  // Cuts `rest`, which lies in cells first…last of the axis, into slabs.
  template <int kAxis>
  void cut_along(const Polygon* rest, int first, int last) {
    Level& level = levels_[kAxis];
    for (int i = first; i < last && rest->n >= 3; ++i) {
      Polygon& above = level.above[(i - first) % 2];
      split(*rest, arithmetic_.plane(kAxis, lattice_.plane(kAxis, i + 1)), level.below, above);
      take_slab<kAxis>(level.below, i);
      rest = &above;
    }
    take_slab<kAxis>(*rest, last);
  }

  template <int kAxis>
  void take_slab(const Polygon& slab, int i) {
    if (slab.n < 3) return;
    cell_[kAxis] = i;
    if constexpr (kAxis == 0) {
      add_cut(slab);
    } else {
      int first = first_[kAxis - 1];
      int last = last_[kAxis - 1];
      if (last - first > 1) {
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        for (int k = 0; k < slab.n; ++k) {
          const double x = arithmetic_.to_double(slab.corners[k])[kAxis - 1];
          low = std::min(low, x);
          high = std::max(high, x);
        }
        const double origin = lattice_.origin[kAxis - 1];
        const auto cell = [&](double x) {
          return static_cast<int>(std::floor((x - origin) / lattice_.voxel_size));
        };
        first = std::max(first, cell(low));
        last = std::min(last, cell(high));
      }
      cut_along<kAxis - 1>(&slab, first, last);
    }
  }

  void split(const Polygon& polygon, const Plane& plane, Polygon& below, Polygon& above) {
    below.n = 0;
    above.n = 0;
    std::array<bool, 13> is_below{};
    for (int i = 0; i < polygon.n; ++i) {
      is_below[i] = arithmetic_.is_below(polygon.corners[i], plane);
    }
    is_below[polygon.n] = is_below[0];
    for (int i = 0; i < polygon.n; ++i) {
      const Point& p = polygon.corners[i];
      (is_below[i] ? below : above).push(p);
      if (is_below[i] != is_below[i + 1]) {
        const Point cut =
            arithmetic_.meet(p, polygon.corners[i + 1 < polygon.n ? i + 1 : 0], plane);
        below.push(cut);
        above.push(cut);
      }
    }
  }

  void add_cut(const Polygon& polygon) {
    double area = 0.0;
    Eigen::Vector3d centroid;
    arithmetic_.measure(polygon.corners.data(), polygon.n, area, centroid);
    if (!(area > 0.0)) return;
    Layer& layer = layer_of_cell();
    const std::size_t first = layer.corners.size();
    double squared = 0.0;
    for (int i = 0; i < polygon.n; ++i) {
      layer.corners.push_back(arithmetic_.to_double(polygon.corners[i]));
      squared = std::max(squared, (layer.corners.back() - centroid).squaredNorm());
    }
    add(layer, area, centroid, first, squared);
  }

  Layer& layer_of_cell() {
    Layer& layer = layers_[cell_[2]];
    if (layer.names.empty() && !spare_.empty()) {
      layer = std::move(spare_.back());
      spare_.pop_back();
    }
    return layer;
  }

  void add(Layer& layer, double area, const Eigen::Vector3d& centroid, std::size_t first,
           double squared) {
    layer.names.push_back({cell_[0] + lattice_.counts[0] * cell_[1], face_,
                           static_cast<std::int32_t>(layer.pieces.size())});
    layer.pieces.push_back({centroid, normal_, area, static_cast<std::int32_t>(first),
                            static_cast<std::int32_t>(layer.corners.size()),
                            static_cast<float>(squared * (1.0 + 1e-6)), face_});
  }

  void sort(std::vector<Name>& names) {
    constexpr int kBits = 11;
    scratch_.resize(names.size());
    const auto order_by = [&](std::int32_t Name::*key, std::int64_t num_keys) {
      for (int shift = 0; ((num_keys - 1) >> shift) > 0; shift += kBits) {
        std::array<std::uint32_t, (1 << kBits) + 1> begin{};
        const auto digit = [&](const Name& name) {
          return static_cast<std::size_t>(name.*key >> shift) & ((1 << kBits) - 1);
        };
        for (const Name& name : names) ++begin[digit(name) + 1];
        for (std::size_t d = 1; d < begin.size(); ++d) begin[d] += begin[d - 1];
        for (const Name& name : names) scratch_[begin[digit(name)]++] = name;
        std::swap(names, scratch_);
      }
    };
    order_by(&Name::face, static_cast<std::int64_t>(mesh_.faces.size()));
    order_by(&Name::cell, std::int64_t{lattice_.counts[0]} * lattice_.counts[1]);
  }

  void average(const Layer& layer, std::size_t k) {
    const std::vector<Name>& names = layer.names;
    for (std::size_t begin = 0, end = 0; begin < names.size(); begin = end) {
      while (end < names.size() && names[end].cell == names[begin].cell) ++end;
      geometry::SurfacePatch& patch = patches_.emplace_back();
      patch.voxel = names[begin].cell +
                    static_cast<std::int64_t>(k) * lattice_.counts[0] * lattice_.counts[1];
      patch.faces.reserve(end - begin);
      Eigen::Vector3d moment = Eigen::Vector3d::Zero();
      Eigen::Vector3d vector_area = Eigen::Vector3d::Zero();
      Eigen::Vector3d normals = Eigen::Vector3d::Zero();
      for (std::size_t i = begin; i < end; ++i) {
        const Piece& piece = layer.pieces[names[i].piece];
        patch.area += piece.area;
        moment += piece.area * piece.centroid;
        vector_area += piece.area * piece.normal;
        normals += piece.normal;
        patch.faces.push_back(piece.face);
      }
      patch.area_centroid = moment / patch.area;
      patch.area_weighted_normal = vector_area / patch.area;
      patch.plain_normal = normals / static_cast<double>(end - begin);
      patch.centroid = projected(layer, patch.area_centroid, begin, end);
      const double length = patch.area_weighted_normal.norm();
      patch.has_normal = length >= 0.1;
      patch.outward_normal = patch.has_normal ? (patch.area_weighted_normal / length).eval()
                                              : Eigen::Vector3d::Zero().eval();
    }
  }

  Eigen::Vector3d projected(const Layer& layer, const Eigen::Vector3d& point, std::size_t begin,
                            std::size_t end) const {
    const auto piece_of = [&](std::size_t i) -> const Piece& {
      return layer.pieces[layer.names[i].piece];
    };
    std::size_t start = begin;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = begin; i < end; ++i) {
      const double squared = (piece_of(i).centroid - point).squaredNorm();
      if (squared < least) {
        least = squared;
        start = i;
      }
    }
    Eigen::Vector3d best = point;
    double best_squared = std::numeric_limits<double>::infinity();
    const auto look = [&](const Piece& piece) {
      const auto try_triangle = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c) {
        const Eigen::Vector3d candidate = nearest_on_triangle(point, a, b, c);
        const double squared = (candidate - point).squaredNorm();
        if (squared < best_squared) {
          best_squared = squared;
          best = candidate;
        }
      };
      if (piece.past_corner == piece.first_corner) {
        const geometry::Face& f = mesh_.faces[piece.face];
        try_triangle(mesh_.vertices[f[0]], mesh_.vertices[f[1]], mesh_.vertices[f[2]]);
      }
      const Eigen::Vector3d* const polygon = layer.corners.data() + piece.first_corner;
      for (std::int32_t n = 2; n < piece.past_corner - piece.first_corner; ++n) {
        try_triangle(polygon[0], polygon[n - 1], polygon[n]);
      }
    };
    look(piece_of(start));
    for (std::size_t i = begin; i < end; ++i) {
      if (i == start) continue;
      const Piece& piece = piece_of(i);
      const double squared = piece.squared_radius;
      const double reach = squared + best_squared + 2.0 * std::sqrt(squared * best_squared);
      if ((piece.centroid - point).squaredNorm() <= reach) look(piece);
    }
    return best;
  }

  struct Level {
    Polygon below;
    std::array<Polygon, 2> above;  // They are used in turns.
  };
  static constexpr std::size_t kAhead = 16;

  const geometry::TriangleMesh& mesh_;
  const geometry::VoxelLattice& lattice_;
  Arithmetic arithmetic_;
  Polygon whole_;
  std::array<Level, 3> levels_;
  std::vector<Eigen::Vector3i> cells_;
  std::vector<Layer> layers_;
  std::vector<Layer> spare_;
  std::vector<Name> scratch_;
  std::vector<geometry::SurfacePatch> patches_;
  Eigen::Vector3d normal_;
  Eigen::Vector3i first_, last_, cell_;
  std::int32_t face_ = -1;
};

}  // namespace graspfit::testing
