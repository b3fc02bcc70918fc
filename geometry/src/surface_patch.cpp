#include "graspfit/geometry/surface_patch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <string>

#include "graspfit/geometry/errors.hpp"
#include "internal/box_tree.hpp"
#include "internal/predicates.hpp"
#include "internal/triangle_clip.hpp"

namespace graspfit::geometry {
namespace {

using internal::CutCorner;
using internal::CutPolygon;

// The least i with x < plane(i + 1): the voxel that holds x, one in a plane being in the higher.
// Exact, since it ends by comparing with the planes themselves.
int cell_of(const VoxelLattice& lattice, int axis, double x) {
  const double quotient = std::floor((x - lattice.origin[axis]) / lattice.voxel_size);
  int i = static_cast<int>(std::clamp(quotient, -2.0, lattice.counts[axis] + 2.0));
  while (i > -2 && x < lattice.plane(axis, i)) --i;
  while (i < lattice.counts[axis] + 2 && x >= lattice.plane(axis, i + 1)) ++i;
  return i;
}

// Cuts one triangle after the other at the planes of a lattice and hands out what falls in each
// voxel.
template <typename VisitWhole, typename Visit>
class VoxelCutter {
 public:
  VoxelCutter(const VoxelLattice& lattice, VisitWhole visit_whole, Visit visit)
      : lattice_(lattice), visit_whole_(visit_whole), visit_(visit) {}

  void cut(const std::array<Eigen::Vector3d, 3>& triangle, std::int32_t face) {
    const auto& [a, b, c] = triangle;
    const Eigen::Vector3d lower = a.cwiseMin(b).cwiseMin(c);
    const Eigen::Vector3d upper = a.cwiseMax(b).cwiseMax(c);
    Eigen::Vector3i first;
    Eigen::Vector3i last;
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = cell_of(lattice_, axis, lower[axis]);
      last[axis] = cell_of(lattice_, axis, upper[axis]);
      // A triangle that ends at a plane has no area beyond it, unless it lies in the plane.
      if (last[axis] > first[axis] && upper[axis] == lattice_.plane(axis, last[axis])) {
        --last[axis];
      }
      if (first[axis] < 0 || last[axis] >= lattice_.counts[axis]) {
        throw InvalidInput("face " + std::to_string(face) + " of the mesh leaves the lattice");
      }
    }
    if (internal::are_collinear(a, b, c)) return;
    face_ = face;
    if (first == last) {
      visit_whole_(lattice_.index(first), face_, triangle);
      return;
    }
    // Where a cut corner can be, away from its computed place (see TriangleCutter).
    slack_ = 0x1p-40 * (upper - lower).maxCoeff() +
             0x1p-50 * lower.cwiseAbs().cwiseMax(upper.cwiseAbs()).maxCoeff();
    cutter_.reset(triangle);
    cutter_.whole(levels_[0].rest);
    cut_along(0, first, last);
  }

  const internal::ClipCounters& counters() const { return cutter_.counters(); }

 private:
  struct Level {
    CutPolygon rest;   // Not yet cut along this axis.
    CutPolygon piece;  // In one slab of this axis and the ones before.
    CutPolygon other;
  };

  // Cuts levels_[axis].rest, which is known to lie in cells first…last of this axis, into slabs.
  void cut_along(int axis, Eigen::Vector3i first, Eigen::Vector3i last) {
    Level& level = levels_[axis];
    for (int i = first[axis]; i <= last[axis]; ++i) {
      if (i == last[axis]) {
        level.piece = level.rest;
        level.rest.clear();
      } else {
        const std::uint32_t line = cutter_.add_axis_plane(axis, lattice_.plane(axis, i + 1));
        cutter_.split(level.rest, line, internal::TriangleCutter::InPlane::Outside, level.piece,
                      &level.other);
        std::swap(level.rest, level.other);
      }
      if (!level.piece.empty()) {
        cell_[axis] = i;
        if (axis == 2) {
          visit_(lattice_.index(cell_), face_, level.piece, cutter_.measure(level.piece));
        } else {
          std::swap(levels_[axis + 1].rest, level.piece);
          Eigen::Vector3i piece_first = first;
          Eigen::Vector3i piece_last = last;
          narrow(levels_[axis + 1].rest, axis + 1, piece_first, piece_last);
          cut_along(axis + 1, piece_first, piece_last);
        }
      }
      if (level.rest.empty()) break;
    }
  }

  // Cells of `axis` that the polygon may reach: outer bounds, so that no exact decision is skipped.
  void narrow(const CutPolygon& polygon, int axis, Eigen::Vector3i& first,
              Eigen::Vector3i& last) const {
    if (first[axis] == last[axis]) return;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const CutCorner& corner : polygon) {
      low = std::min(low, corner.point[axis]);
      high = std::max(high, corner.point[axis]);
    }
    first[axis] = std::max(first[axis], cell_of(lattice_, axis, low - slack_));
    last[axis] = std::min(last[axis], cell_of(lattice_, axis, high + slack_));
  }

  const VoxelLattice& lattice_;
  VisitWhole visit_whole_;
  Visit visit_;
  internal::TriangleCutter cutter_;
  std::array<Level, 3> levels_;
  Eigen::Vector3i cell_;
  double slack_ = 0.0;
  std::int32_t face_ = -1;
};

void check(const VoxelLattice& lattice) {
  if (!(lattice.voxel_size > 0.0) || !std::isfinite(lattice.voxel_size) ||
      (lattice.counts.array() < 1).any()) {
    throw InvalidInput("the lattice is empty");
  }
}

// A piece as it comes out of the cutter, its polygon in a list common to all.
struct Piece {
  std::int64_t voxel;
  std::int32_t face;
  std::int32_t num_corners;
  std::size_t first_corner;
  double area;
  Eigen::Vector3d centroid;
};

struct Pieces {
  std::vector<Piece> pieces;  // Ascending by voxel, then face.
  std::vector<Eigen::Vector3d> corners;
};

// Orders pieces by voxel, keeping the order of faces within each: a few passes over digits of the
// voxel's index, which takes a fraction of the time of comparing.
std::vector<Piece> sorted_by_voxel(const std::vector<Piece>& pieces, std::int64_t num_voxels) {
  constexpr int kDigitBits = 11;
  struct Entry {
    std::int64_t voxel;
    std::size_t piece;
  };
  std::vector<Entry> entries;
  entries.reserve(pieces.size());
  for (const Piece& piece : pieces) entries.push_back({piece.voxel, entries.size()});
  std::vector<Entry> next(entries.size());
  for (int shift = 0; (num_voxels >> shift) > 0; shift += kDigitBits) {
    const auto digit = [&](const Entry& entry) {
      return static_cast<std::size_t>(entry.voxel >> shift) & ((1 << kDigitBits) - 1);
    };
    std::array<std::size_t, (1 << kDigitBits) + 1> begin{};
    for (const Entry& entry : entries) ++begin[digit(entry) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for (const Entry& entry : entries) next[begin[digit(entry)]++] = entry;
    std::swap(entries, next);
  }
  std::vector<Piece> sorted;
  sorted.reserve(pieces.size());
  for (const Entry& entry : entries) sorted.push_back(pieces[entry.piece]);
  return sorted;
}

Pieces all_pieces(const TriangleMesh& mesh, const VoxelLattice& lattice,
                  const std::vector<double>& face_areas) {
  check(lattice);
  Pieces result;
  std::vector<Piece> pieces;
  pieces.reserve(mesh.faces.size() * 2);
  result.corners.reserve(mesh.faces.size() * 7);
  const auto visit_whole = [&](std::int64_t voxel, std::int32_t face,
                               const std::array<Eigen::Vector3d, 3>& triangle) {
    const auto& [a, b, c] = triangle;
    pieces.push_back(
        {voxel, face, 3, result.corners.size(), face_areas[face], a + ((b - a) + (c - a)) / 3.0});
    result.corners.insert(result.corners.end(), triangle.begin(), triangle.end());
  };
  const auto visit = [&](std::int64_t voxel, std::int32_t face, const CutPolygon& polygon,
                         const internal::CutMeasure& measure) {
    pieces.push_back({voxel, face, static_cast<std::int32_t>(polygon.size()), result.corners.size(),
                      measure.fraction * face_areas[face], measure.centroid});
    for (const CutCorner& corner : polygon) result.corners.push_back(corner.point);
  };
  VoxelCutter cutter(lattice, visit_whole, visit);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    cutter.cut(corners(mesh, face), static_cast<std::int32_t>(face));
  }
  result.pieces = sorted_by_voxel(pieces, lattice.num_voxels());
  return result;
}

// The point of some polygons nearest to `point`.
Eigen::Vector3d projected(const Eigen::Vector3d& point, std::span<const Piece> pieces,
                          const std::vector<Eigen::Vector3d>& corners) {
  Eigen::Vector3d best = point;
  double best_squared = std::numeric_limits<double>::infinity();
  for (const Piece& piece : pieces) {
    const Eigen::Vector3d* const polygon = corners.data() + piece.first_corner;
    for (std::int32_t i = 2; i < piece.num_corners; ++i) {
      const Eigen::Vector3d candidate =
          internal::closest_on_triangle(point, {polygon[0], polygon[i - 1], polygon[i]});
      const double squared = (candidate - point).squaredNorm();
      if (squared < best_squared) {
        best_squared = squared;
        best = candidate;
      }
    }
  }
  return best;
}

}  // namespace

std::vector<SurfacePatch> surface_patches(const TriangleMesh& mesh, const VoxelLattice& lattice,
                                          const SurfacePatchOptions& options) {
  std::vector<double> areas(mesh.faces.size());
  std::vector<Eigen::Vector3d> normals(mesh.faces.size());
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const auto [a, b, c] = corners(mesh, face);
    const Eigen::Vector3d area = internal::accurate_vector_area(a, b, c);
    areas[face] = area.stableNorm();
    normals[face] = area.stableNormalized();
  }
  const Pieces all = all_pieces(mesh, lattice, areas);

  std::vector<SurfacePatch> patches;
  for (auto begin = all.pieces.begin(); begin != all.pieces.end();) {
    const auto end = std::find_if(begin, all.pieces.end(),
                                  [&](const Piece& piece) { return piece.voxel != begin->voxel; });
    SurfacePatch patch;
    patch.voxel = begin->voxel;
    patch.faces.reserve(static_cast<std::size_t>(end - begin));
    double weights = 0.0;
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (auto piece = begin; piece != end; ++piece) {
      const double weight = options.averaging == PatchAveraging::AreaWeighted ? piece->area : 1.0;
      patch.area += piece->area;
      weights += weight;
      // Relative to the first, so that far from the origin no digits are lost.
      centroid += weight * (piece->centroid - begin->centroid);
      normal += weight * normals[piece->face];
      patch.faces.push_back(piece->face);
    }
    centroid = begin->centroid + centroid / weights;
    patch.centroid = projected(centroid, {begin, end}, all.corners);
    patch.has_normal = normal.norm() >= 0.1 * weights;
    patch.outward_normal = patch.has_normal ? normal.normalized().eval() : Eigen::Vector3d::Zero();
    patches.push_back(std::move(patch));
    begin = end;
  }
  return patches;
}

std::vector<VoxelPiece> clip_by_voxels(const TriangleMesh& mesh, const VoxelLattice& lattice) {
  std::vector<double> areas(mesh.faces.size());
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const auto [a, b, c] = corners(mesh, face);
    areas[face] = internal::accurate_vector_area(a, b, c).stableNorm();
  }
  const Pieces all = all_pieces(mesh, lattice, areas);
  std::vector<VoxelPiece> result;
  result.reserve(all.pieces.size());
  for (const Piece& piece : all.pieces) {
    const auto first = all.corners.begin() + static_cast<std::ptrdiff_t>(piece.first_corner);
    result.push_back(
        {piece.voxel,
         {{first, first + piece.num_corners}, piece.area, piece.centroid, piece.face}});
  }
  return result;
}

}  // namespace graspfit::geometry
