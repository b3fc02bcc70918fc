#include "feature/solid_opening.hpp"

#include <algorithm>
#include <cmath>

#include "graspfit/base/bounded_integer.hpp"
#include "graspfit/base/parallel_for.hpp"
#include "graspfit/geometry/distance_map.hpp"
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

/// The voxels near some given ones, by blocks.
class NearVoxels {
 public:
  /// All voxels at most `reach` voxels from one that is added are near, and some farther ones: all
  /// voxels, where `reach` is as large as the lattice.
  NearVoxels(const VoxelLattice& lattice, double reach)
      : edge_(base::bounded_integer(std::ceil(reach), 1, lattice.counts.maxCoeff())),
        counts_((lattice.counts.array() + edge_ - 1) / edge_),
        is_near_(counts_.prod(), 0) {}

  void add(const Vector3i& voxel) {
    const Vector3i block = voxel / edge_;
    const Vector3i low = (block.array() - 1).max(0);
    const Vector3i high = (block.array() + 1).min(counts_.array() - 1);
    for_each_in_block(low, high, [&](const Vector3i& other) { is_near_[at(other)] = 1; });
  }
  bool has(const Vector3i& voxel) const { return is_near_[at(voxel / edge_)] != 0; }

 private:
  std::size_t at(const Vector3i& block) const {
    return block[0] + counts_[0] * (block[1] + static_cast<std::size_t>(counts_[1]) * block[2]);
  }

  int edge_;
  Vector3i counts_;
  std::vector<char> is_near_;
};

/// Lowers distances at `voxels` to those from `centers`, where these are at most `reach` voxels.
void take_nearer(const VoxelLattice& lattice, const std::vector<Index>& voxels,
                 const std::vector<Index>& centers, double reach, std::vector<float>& distance) {
  Vector3i low = lattice.counts;
  Vector3i high = Vector3i::Zero();
  for (const Index index : voxels) {
    low = low.cwiseMin(lattice.voxel(index));
    high = high.cwiseMax(lattice.voxel(index));
  }
  const int margin = base::bounded_integer(std::ceil(reach), 0, lattice.counts.maxCoeff());
  low = (low.array() - margin).max(0);
  high = (high.array() + margin).min(lattice.counts.array() - 1);
  VoxelGrid part;
  part.lattice = {lattice.origin, lattice.voxel_size, high - low + Vector3i::Ones()};
  part.classes.assign(part.lattice.num_voxels(), VoxelClass::Empty);
  for (const Index index : centers) {
    const Vector3i voxel = lattice.voxel(index) - low;
    if (part.lattice.contains(voxel)) {
      part.classes[part.lattice.index(voxel)] = VoxelClass::Partial;
    }
  }
  const SignedDistanceMap map = signed_distance_map(part);
  for (const Index index : voxels) {
    distance[index] = std::min(distance[index], map.at(Vector3i(lattice.voxel(index) - low)));
  }
}

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

  // Voxels that surely hold a ball's center, and voxels that only the surface can decide.
  SolidOpening result;
  std::vector<Index> unsure;
  {
    const SignedDistanceMap map = signed_distance_map(grid);
    VoxelGrid sure{lattice, std::vector<VoxelClass>(grid.classes.size(), VoxelClass::Empty)};
    for (Index i = 0; i < std::ssize(grid.classes); ++i) {
      if (grid.classes[i] == VoxelClass::Empty) continue;
      // Surface lies within half a diagonal of each partial voxel's center, and only there.
      const double depth = std::abs(map.values[i]);
      if (grid.classes[i] == VoxelClass::Full && depth - kHalfDiagonal >= in_voxels) {
        sure.classes[i] = VoxelClass::Partial;
      } else if (depth + 2.0 * kHalfDiagonal >= in_voxels) {
        unsure.push_back(i);
      }
    }
    result.to_center = signed_distance_map(sure).values;
  }
  result.is_opened.assign(grid.classes.size(), 0);
  std::vector<Index> residue;
  for (Index i = 0; i < std::ssize(grid.classes); ++i) {
    if (grid.classes[i] == VoxelClass::Empty) continue;
    result.is_opened[i] = result.to_center[i] <= reach(i);
    if (!result.is_opened[i]) residue.push_back(i);
  }
  if (residue.empty()) return result;

  // Other voxels matter only where they may open a voxel, or be nearest to one next to an opened
  // one.
  const double farthest = in_voxels + slack + 3.0 * kHalfDiagonal;
  NearVoxels near(lattice, farthest);
  for (const Index index : residue) near.add(lattice.voxel(index));
  std::erase_if(unsure, [&](Index index) { return !near.has(lattice.voxel(index)); });
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
    take_nearer(lattice, residue, centers, farthest, result.to_center);
    for (const Index index : residue) {
      result.is_opened[index] = result.to_center[index] <= reach(index);
    }
  } else if (std::find(result.is_opened.begin(), result.is_opened.end(), 1) ==
             result.is_opened.end()) {
    return std::nullopt;
  }
  return result;
}

}  // namespace graspfit::geometry::internal
