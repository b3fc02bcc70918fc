#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "graspfit/grasp/object_model.hpp"

namespace graspfit::grasp::internal {

/// For every voxel of an object's lattice one of some patches: the one with the nearest centroid,
/// or nearly so; a voxel with such a patch has its own. A question costs a look-up, some
/// nanoseconds.
class NearestPatches {
 public:
  /// Refers to the object. Unless some entry of `is_meant`, parallel to its patches, is true,
  /// nothing may be asked.
  NearestPatches(const ObjectModel& object, const std::vector<bool>& is_meant);

  /// Index of the patch for the voxel that holds `point_O`, or for the lattice's voxel nearest to
  /// it.
  std::int32_t at(const Eigen::Vector3d& point_O) const {
    const Eigen::Array3d position = (point_O - lattice_.origin).array() * inverse_size_;
    const Eigen::Array3d inside = position.max(0.0).min(last_voxel_);
    return patch_of_voxel_[lattice_.index(inside.cast<int>().matrix())];
  }

 private:
  const geometry::VoxelLattice& lattice_;
  const double inverse_size_ = 1.0 / lattice_.voxel_size;
  Eigen::Array3d last_voxel_;
  std::vector<std::int32_t> patch_of_voxel_;
};

}  // namespace graspfit::grasp::internal
