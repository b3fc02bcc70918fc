#include "object/nearest_patches.hpp"

#include <array>
#include <limits>

namespace graspfit::grasp::internal {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// Sweeps of the lattice, forth and back on each axis, in which a voxel takes over the patch of a
/// neighbor if that is nearer than its own.
NearestPatches::NearestPatches(const ObjectModel& object, const std::vector<bool>& is_meant)
    : lattice_(object.grid.lattice),
      last_voxel_((lattice_.counts.array() - 1).cast<double>()),
      patch_of_voxel_(object.patch_of_voxel) {
  for (std::int32_t& patch : patch_of_voxel_) {
    if (patch >= 0 && !is_meant[patch]) patch = -1;
  }
  std::vector<float> squared(patch_of_voxel_.size(), std::numeric_limits<float>::infinity());
  const auto distance = [&](const Vector3i& voxel, std::int32_t patch) {
    const Vector3d center =
        lattice_.origin + lattice_.voxel_size * (voxel.cast<double>().array() + 0.5).matrix();
    return static_cast<float>((center - object.patches[patch].centroid).squaredNorm());
  };
  const auto visit = [&](const Vector3i& voxel) {
    const std::int64_t index = lattice_.index(voxel);
    if (patch_of_voxel_[index] >= 0 && squared[index] == 0.0F) return;
    for (int axis = 0; axis < 3; ++axis) {
      for (const int step : {-1, 1}) {
        Vector3i neighbor = voxel;
        neighbor[axis] += step;
        if (neighbor[axis] < 0 || neighbor[axis] >= lattice_.counts[axis]) continue;
        const std::int32_t patch = patch_of_voxel_[lattice_.index(neighbor)];
        if (patch < 0) continue;
        const float candidate = distance(voxel, patch);
        if (!(candidate < squared[index])) continue;
        squared[index] = candidate;
        patch_of_voxel_[index] = patch;
      }
    }
  };
  for (std::size_t i = 0; i < squared.size(); ++i) {
    if (patch_of_voxel_[i] >= 0) squared[i] = 0.0F;  // a partial voxel keeps its own
  }
  const Vector3i n = lattice_.counts;
  const auto sweep = [&](bool is_back) {
    for (int a = 0; a < n[0]; ++a) {
      for (int b = 0; b < n[1]; ++b) {
        for (int c = 0; c < n[2]; ++c) {
          visit(is_back ? Vector3i(n[0] - 1 - a, n[1] - 1 - b, n[2] - 1 - c) : Vector3i(a, b, c));
        }
      }
    }
  };
  for (int round = 0; round < 2; ++round) {
    sweep(false);
    sweep(true);
  }
}

}  // namespace graspfit::grasp::internal
