#pragma once

#include <cstdint>
#include <vector>

#include "graspfit/geometry/voxel_grid.hpp"

namespace graspfit::geometry::internal {

/// Distances [voxels] from the center of each voxel of a lattice to the nearest center of some of
/// its voxels, as far as they are at most a bound: those of `signed_distance_map`, in a fraction of
/// its time for bounds of some ten voxels, as whole rows are compared at once in numbers of 16
/// bits.
class BoundedDistance {
 public:
  /// @param is_source one per voxel of the lattice, 0 or 1
  /// @param bound ≥ 0; no more than `kLargestBound`, unless the lattice's diagonal is not
  BoundedDistance(const VoxelLattice& lattice, const std::vector<char>& is_source, double bound);

  static constexpr int kLargestBound = 120;  ///< [voxels]

  /// The float nearest to the distance; infinite above the bound.
  float at(std::int64_t index) const { return distances_[squared_[index]]; }

 private:
  using Squared = std::int16_t;
  std::vector<Squared> squared_;  ///< [voxels²], at most one more than the bound allows.
  std::vector<float> distances_;  ///< Per squared distance.
};

}  // namespace graspfit::geometry::internal
