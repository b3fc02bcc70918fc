#include "feature/solid_opening.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "graspfit/base/bounded_integer.hpp"
#include "graspfit/base/parallel_for.hpp"
#include "voxel/bounded_distance.hpp"
#include "voxel/voxel_sets.hpp"

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kHalfDiagonal = 0.8660254037844387;  // Of a voxel, in voxels: √3 / 2.
// Depth over the radius of the residue along a crease that is no feature.
constexpr double kFillet = 0.5;

/// Whether a ball of `radius` inside the solid has its center in the voxel: starting at the voxel's
/// center, the ball that touches the nearest surface point is moved inward until it fits.
bool holds_ball_center(const MeshQuery& object, const VoxelLattice& lattice, Index index,
                       double radius) {
  constexpr int kMostMoves = 8;
  constexpr double kFit = 1.0 - 1e-6;  // Moves converge from below.
  const Vector3d start = lattice.center(lattice.voxel(index));
  const double reach = kHalfDiagonal * lattice.voxel_size;
  Vector3d center = start;
  for (int move = 0; move < kMostMoves; ++move) {
    const ClosestPoint closest = object.closest_point(center);
    const double distance = std::sqrt(closest.squared_distance);
    if (distance >= kFit * radius) return true;
    if (distance == 0.0) return false;
    center += (center - closest.point) / distance * (radius - distance);
    if ((center - start).norm() > reach) return false;
  }
  return false;
}

/// The box of some voxels of a lattice, with a margin.
class LatticePart {
 public:
  LatticePart(const VoxelLattice& lattice, const std::vector<Index>& voxels, double margin)
      : whole_(lattice), low_(lattice.counts) {
    Vector3i high = Vector3i::Zero();
    for (const Index index : voxels) {
      low_ = low_.cwiseMin(lattice.voxel(index));
      high = high.cwiseMax(lattice.voxel(index));
    }
    const int most = base::bounded_integer(std::ceil(margin), 0, lattice.counts.maxCoeff());
    low_ = (low_.array() - most).max(0);
    high = (high.array() + most).min(lattice.counts.array() - 1);
    part_ = {lattice.origin, lattice.voxel_size, high - low_ + Vector3i::Ones()};
  }

  /// Index in the part of a voxel of the lattice; empty outside it.
  std::optional<Index> at(Index index) const {
    const Vector3i voxel = whole_.voxel(index) - low_;
    return part_.contains(voxel) ? std::optional<Index>(part_.index(voxel)) : std::nullopt;
  }

  /// Distances of the part's voxels from those of `voxels` that are in it.
  BoundedDistance distance_from(const std::vector<Index>& voxels, double bound) const {
    std::vector<char> is_source(part_.num_voxels(), 0);
    for (const Index index : voxels) {
      if (const std::optional<Index> own = at(index)) is_source[*own] = 1;
    }
    return {part_, is_source, bound};
  }

 private:
  const VoxelLattice& whole_;
  Vector3i low_;
  VoxelLattice part_;
};

}  // namespace

std::optional<SolidOpening> open_solid(const MeshQuery& object, const VoxelGrid& grid,
                                       double radius, int num_threads) {
  const VoxelLattice& lattice = grid.lattice;
  const double in_voxels = radius / lattice.voxel_size;
  // A voxel is opened if it may be within the radius plus a fillet of a ball's center. A ball's
  // center lies up to half a diagonal from the center of its voxel, and so does the solid's part of
  // a partial voxel. The fillet keeps apart neighboring features that share a crease at their
  // roots.
  const double slack = std::max(kHalfDiagonal, kFillet * in_voxels);
  const auto reach = [&](Index i) {
    return in_voxels + slack + (grid.classes[i] == VoxelClass::Partial ? kHalfDiagonal : 0.0);
  };

  // Farther centers neither open a voxel nor are nearest to one next to an opened one.
  const double farthest = in_voxels + slack + 3.0 * kHalfDiagonal;

  // Voxels that surely hold a ball's center, and voxels that only the surface can decide.
  SolidOpening result;
  std::vector<Index> unsure;
  std::vector<char> is_sure(grid.classes.size(), 0);
  {
    std::vector<char> is_partial(grid.classes.size());
    std::transform(grid.classes.begin(), grid.classes.end(), is_partial.begin(),
                   [](VoxelClass c) { return static_cast<char>(c == VoxelClass::Partial); });
    const BoundedDistance to_surface(lattice, is_partial, in_voxels + 2.0 * kHalfDiagonal);
    for (Index i = 0; i < std::ssize(grid.classes); ++i) {
      if (grid.classes[i] == VoxelClass::Empty) continue;
      // Surface lies within half a diagonal of each partial voxel's center, and only there.
      const double depth = to_surface.at(i);
      if (grid.classes[i] == VoxelClass::Full && depth - kHalfDiagonal >= in_voxels) {
        is_sure[i] = 1;
      } else if (depth + 2.0 * kHalfDiagonal >= in_voxels) {
        unsure.push_back(i);
      }
    }
  }
  const BoundedDistance to_sure(lattice, is_sure, farthest);
  result.to_center.assign(grid.classes.size(), std::numeric_limits<float>::infinity());
  result.is_opened.assign(grid.classes.size(), 0);
  std::vector<Index> residue;
  for (Index i = 0; i < std::ssize(grid.classes); ++i) {
    if (grid.classes[i] == VoxelClass::Empty) continue;
    result.to_center[i] = to_sure.at(i);
    result.is_opened[i] = result.to_center[i] <= reach(i);
    if (!result.is_opened[i]) residue.push_back(i);
  }
  if (residue.empty()) return result;

  const LatticePart part(lattice, residue, farthest);
  {
    const BoundedDistance to_residue = part.distance_from(residue, farthest);
    std::erase_if(unsure, [&](Index index) {
      const std::optional<Index> own = part.at(index);
      return !own || std::isinf(to_residue.at(*own));
    });
  }
  std::vector<char> is_center(unsure.size(), 0);
  base::parallel_for(unsure.size(), num_threads, [&](std::size_t k) {
    const Index i = unsure[k];
    const bool is_inside =
        grid.classes[i] == VoxelClass::Full ||
        object.containment(lattice.center(lattice.voxel(i))) == Containment::Inside;
    is_center[k] = is_inside && holds_ball_center(object, lattice, i, radius);
  });
  std::vector<Index> centers;
  for (std::size_t k = 0; k < unsure.size(); ++k) {
    if (is_center[k]) centers.push_back(unsure[k]);
  }
  if (!centers.empty()) {
    const BoundedDistance to_further = part.distance_from(centers, farthest);
    for (const Index index : residue) {
      result.to_center[index] = std::min(result.to_center[index], to_further.at(*part.at(index)));
      result.is_opened[index] = result.to_center[index] <= reach(index);
    }
  } else if (std::find(result.is_opened.begin(), result.is_opened.end(), 1) ==
             result.is_opened.end()) {
    return std::nullopt;
  }
  return result;
}

}  // namespace graspfit::geometry::internal
