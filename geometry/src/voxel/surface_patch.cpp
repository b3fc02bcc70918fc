#include "graspfit/geometry/surface_patch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "query/indexed_triangle.hpp"
#include "voxel/voxel_cutter.hpp"

namespace graspfit::geometry {
namespace {

using internal::CutLayer;
using internal::CutPiece;
using internal::CutPieceName;
using internal::VoxelCutter;

// Factor on squared distances that covers the rounding of a piece's radius to a float and the
// rounding of the distances.
constexpr double kRoundingFactor = 1.0 + 1e-6;

// The point of some pieces nearest to `point`; of equally near ones that of the first. A piece lies
// in a ball about its centroid, so that most need not be looked at once a near one is known.
class PatchProjection {
 public:
  PatchProjection(const TriangleMesh& mesh, const CutLayer& all, const Eigen::Vector3d& point)
      : mesh_(mesh), all_(all), point_(point) {}

  Eigen::Vector3d nearest(std::span<const CutPieceName> names) {
    std::int32_t start = names.front().piece;
    double least = std::numeric_limits<double>::infinity();
    for (const CutPieceName& name : names) {
      const double squared = (all_.pieces[name.piece].centroid - point_).squaredNorm();
      if (squared < least) {
        least = squared;
        start = name.piece;
      }
    }
    visit(start);
    for (const CutPieceName& name : names) {
      if (name.piece == start) continue;
      // Too far if the centroid is farther than radius and best distance together. A radius too
      // small or too large for a float says nothing.
      const CutPiece& piece = all_.pieces[name.piece];
      const double r_squared = piece.squared_radius;
      const double reach = r_squared + squared_ + 2.0 * std::sqrt(r_squared * squared_);
      if (r_squared > kLeastRadius &&
          (piece.centroid - point_).squaredNorm() > reach * kRoundingFactor)
        continue;
      visit(name.piece);
    }
    return best_;
  }

 private:
  static constexpr float kLeastRadius = 0x1p-120F;

  void visit(std::int32_t piece) {
    if (all_.is_whole(piece)) {
      visit(piece, corners(mesh_, all_.pieces[piece].face));
      return;
    }
    const auto polygon = all_.polygon(piece);
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      visit(piece, {polygon[0], polygon[i - 1], polygon[i]});
    }
  }

  void visit(std::int32_t piece, const std::array<Eigen::Vector3d, 3>& triangle) {
    const Eigen::Vector3d candidate = internal::closest_on_triangle(point_, triangle);
    const double squared = (candidate - point_).squaredNorm();
    if (!piece_ || squared < squared_ ||
        (squared == squared_ && all_.pieces[piece].face < all_.pieces[*piece_].face)) {
      squared_ = squared;
      piece_ = piece;
      best_ = candidate;
    }
  }

  const TriangleMesh& mesh_;
  const CutLayer& all_;
  const Eigen::Vector3d& point_;
  Eigen::Vector3d best_ = point_;
  double squared_ = std::numeric_limits<double>::infinity();
  std::optional<std::int32_t> piece_;  // of the best point
};

// About the number of patches: a surface of area A meets 1.5 A / h² voxels of edge h on average
// over its directions. The area is estimated from every 16th face, and an eighth is added. Where
// sheets lie close, voxels share them, so that the number is limited to that of the surface of a
// box of the lattice's size.
std::size_t expected_patches(const TriangleMesh& mesh, const VoxelLattice& lattice) {
  constexpr std::int32_t kStride = 16;
  double area = 0.0;
  for (std::int64_t face = 0; face < std::ssize(mesh.faces); face += kStride) {
    area += kStride * vector_area(mesh, face).norm();
  }
  const Eigen::Vector3d n = lattice.counts.cast<double>();
  const double most = 2.0 * (n[0] * n[1] + n[1] * n[2] + n[2] * n[0]);
  const double expected = 1.125 * 1.5 * area / (lattice.voxel_size * lattice.voxel_size);
  if (!std::isfinite(expected)) return 0;  // So small that squares of lengths vanish.
  return static_cast<std::size_t>(std::min(expected, most));
}

// The patch of the pieces of one voxel.
SurfacePatch patch_of(const TriangleMesh& mesh, const CutLayer& layer,
                      std::span<const CutPieceName> names, const SurfacePatchOptions& options) {
  SurfacePatch patch;
  patch.faces.reserve(names.size());
  // Relative to the first, so that far from the origin no digits are lost.
  const Eigen::Vector3d reference = layer.pieces[names.front().piece].centroid;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum_of_centroids = Eigen::Vector3d::Zero();
  Eigen::Vector3d vector_area = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum_of_normals = Eigen::Vector3d::Zero();
  for (const CutPieceName& name : names) {
    const CutPiece& piece = layer.pieces[name.piece];
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

VoxelPiece voxel_piece(const TriangleMesh& mesh, const CutLayer& layer, const CutPieceName& name,
                       std::int64_t first_voxel) {
  const CutPiece& piece = layer.pieces[name.piece];
  VoxelPiece result;
  result.voxel = first_voxel + name.cell;
  result.piece.area = piece.area;
  result.piece.centroid = piece.centroid;
  result.piece.face = piece.face;
  if (layer.is_whole(name.piece)) {
    const auto triangle = corners(mesh, piece.face);
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
  cutter.run([&](const CutLayer& layer, std::int64_t first_voxel) {
    if (patches.empty()) patches.reserve(expected_patches(mesh, lattice));
    const std::span<const CutPieceName> names = layer.names;
    for (std::size_t begin = 0, end = 0; begin < names.size(); begin = end) {
      while (end < names.size() && names[end].cell == names[begin].cell) ++end;
      patches.push_back(patch_of(mesh, layer, names.subspan(begin, end - begin), options));
      patches.back().voxel = first_voxel + names[begin].cell;
    }
  });
  return patches;
}

std::vector<std::int64_t> surface_voxels(const TriangleMesh& mesh, const VoxelLattice& lattice) {
  VoxelCutter cutter(mesh, lattice);
  std::vector<std::int64_t> voxels;
  cutter.run([&](const CutLayer& layer, std::int64_t first_voxel) {
    for (const CutPieceName& name : layer.names) {
      const std::int64_t voxel = first_voxel + name.cell;
      if (voxels.empty() || voxels.back() != voxel) voxels.push_back(voxel);
    }
  });
  return voxels;
}

std::vector<VoxelPiece> clip_by_voxels(const TriangleMesh& mesh, const VoxelLattice& lattice) {
  VoxelCutter cutter(mesh, lattice);
  std::vector<VoxelPiece> pieces;
  cutter.run([&](const CutLayer& layer, std::int64_t first_voxel) {
    for (const CutPieceName& name : layer.names) {
      pieces.push_back(voxel_piece(mesh, layer, name, first_voxel));
    }
  });
  return pieces;
}

}  // namespace graspfit::geometry
