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
  /// Lowest and highest partial voxel on each axis; the lattice's opposite ends if there is none.
  Eigen::Vector3i first_partial = Eigen::Vector3i::Zero();
  Eigen::Vector3i last_partial = Eigen::Vector3i::Zero();

  float at(const Eigen::Vector3i& voxel) const { return values[lattice.index(voxel)]; }

  /// Value of the voxel that holds `point`, or that would, if the lattice went on beyond its sides.
  ///
  /// There it is a bound from below, never above what a larger lattice would hold, and like the
  /// values inside it changes by at most a voxel per voxel: with c the nearest voxel of the
  /// lattice, e the steps per axis to it, and g those from c to the box of all partial voxels,
  /// any partial voxel is at least √(value(c)² + |e|² + 2 e·g) away. Equal to the true distance
  /// where the partial voxel nearest to c lies at that box's side, as straight before a flat face.
  /// Beyond a side at which the lattice holds a full voxel nothing is known: c's value.
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
