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
  float at(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d place = (point - lattice.origin) / lattice.voxel_size;
    // The fitting loop lives on this: inside, cutting off is rounding down.
    const bool is_inside = place[0] >= 0.0 && place[0] < lattice.counts[0] && place[1] >= 0.0 &&
                           place[1] < lattice.counts[1] && place[2] >= 0.0 &&
                           place[2] < lattice.counts[2];
    return is_inside ? at(Eigen::Vector3i(place.cast<int>())) : at_beyond(place);
  }

 private:
  /// `place` is a point beyond the lattice, in voxels from its origin.
  float at_beyond(const Eigen::Vector3d& place) const;
};

/// Exact squared Euclidean transform in linear time [Felzenszwalb & Huttenlocher 2012].
/// Without any partial voxel all values are +infinity.
SignedDistanceMap signed_distance_map(const VoxelGrid& grid);

}  // namespace graspfit::geometry
