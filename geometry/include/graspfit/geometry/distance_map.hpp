#pragma once

#include <Eigen/Core>
#include <vector>

#include "graspfit/geometry/voxel_grid.hpp"

namespace graspfit::geometry {

/// The paper's signed distance map: Euclidean distance, in voxels, from each voxel's center to that
/// of the nearest partial voxel; positive in empty voxels, zero in partial, negative in full ones.
struct SignedDistanceMap {
  VoxelLattice lattice;
  std::vector<float> values;  ///< Signed distances [voxels], one per voxel in index order. Each
                              ///< magnitude is the float nearest to the square root of an exact
                              ///< integer.
  /// Lowest and highest partial voxel on each axis; the lattice's opposite ends if there is none.
  Eigen::Vector3i first_partial = Eigen::Vector3i::Zero();
  Eigen::Vector3i last_partial = Eigen::Vector3i::Zero();

  float at(const Eigen::Vector3i& voxel) const { return values[lattice.index(voxel)]; }

  /// Value of the voxel that holds `point`. Outside the lattice it is a value for the voxel that
  /// would hold `point` if the lattice continued beyond its sides.
  ///
  /// Outside the lattice the value is a lower bound: it never exceeds what a larger lattice would
  /// hold, and like the values inside it changes by at most one per voxel. Let c be the voxel of
  /// the lattice nearest to that voxel, e the steps per axis from c to that voxel (1 to a
  /// neighbor), and g the steps per axis from c to the box of all partial voxels (0 inside it). The
  /// value is √(value(c)² + |e|² + 2 e·g): any partial voxel is at least that far away. It is the
  /// true distance where the partial voxel nearest to c lies on the side of the box toward the
  /// point, as straight in front of a flat face. Where c is a full voxel nothing is known, and the
  /// value is that of c.
  /// @throws InvalidInput for a point with a coordinate that is no number.
  float at(const Eigen::Vector3d& point) const {
    return at_position((point - lattice.origin) / lattice.voxel_size);
  }

  /// The same for a position from the lattice's origin [voxels].
  float at_position(const Eigen::Vector3d& position) const {
    // This is the hot path of the fitting loop. Inside the lattice truncation rounds down.
    const bool is_inside = position[0] >= 0.0 && position[0] < lattice.counts[0] &&
                           position[1] >= 0.0 && position[1] < lattice.counts[1] &&
                           position[2] >= 0.0 && position[2] < lattice.counts[2];
    return is_inside ? at(Eigen::Vector3i(position.cast<int>())) : at_beyond(position);
  }

 private:
  /// `at` for a point outside the lattice; `position` is its position in voxels from the lattice's
  /// origin.
  float at_beyond(const Eigen::Vector3d& position) const;
};

/// Computes the map in linear time, by the exact squared Euclidean distance transform [Felzenszwalb
/// & Huttenlocher 2012]. Without any partial voxel all values are +infinity.
SignedDistanceMap signed_distance_map(const VoxelGrid& grid);

}  // namespace graspfit::geometry
