#pragma once

#include <Eigen/Core>
#include <vector>

#include "graspfit/geometry/voxel_grid.hpp"

namespace graspfit::geometry {

/// The paper's signed distance map: Euclidean distance, in voxels, from each voxel's center to that
/// of the nearest partial voxel; positive in empty voxels, zero in partial, negative in full ones.
struct SignedDistanceMap {
  VoxelLattice lattice;
  std::vector<float> values;  ///< In voxels, one per voxel in index order. Nearest float to the
                              ///< root of an exact integer.

  float at(const Eigen::Vector3i& voxel) const { return values[lattice.index(voxel)]; }

  /// Value of the voxel that holds `point`; outside the lattice the index is clamped and the
  /// distance (in voxels) to the clamped voxel's center is added.
  float at(const Eigen::Vector3d& point) const;
};

/// Exact squared Euclidean transform in linear time [Felzenszwalb & Huttenlocher 2012].
/// Without any partial voxel all values are +infinity.
SignedDistanceMap signed_distance_map(const VoxelGrid& grid);

}  // namespace graspfit::geometry
