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
  struct Nearest {
    std::int32_t patch = -1;
    float squared = std::numeric_limits<float>::infinity();
  };
  const Vector3i n = lattice_.counts;
  // In the order of the sweeps, in which the third axis is the fastest.
  const std::array<std::int64_t, 3> strides = {std::int64_t{n[1]} * n[2], n[2], 1};
  std::vector<Nearest> nearest(patch_of_voxel_.size());
  const auto for_each_voxel = [&](bool is_back, const auto& visit) {
    const auto number = [&](int i, int axis) { return is_back ? n[axis] - 1 - i : i; };
    for (int a = 0; a < n[0]; ++a) {
      for (int b = 0; b < n[1]; ++b) {
        for (int c = 0; c < n[2]; ++c) {
          const Vector3i voxel(number(a, 0), number(b, 1), number(c, 2));
          visit(voxel, voxel[0] * strides[0] + voxel[1] * strides[1] + voxel[2]);
        }
      }
    }
  };
  for_each_voxel(false, [&](const Vector3i& voxel, std::int64_t index) {
    const std::int32_t patch = patch_of_voxel_[lattice_.index(voxel)];
    // A partial voxel keeps its own.
    if (patch >= 0 && is_meant[patch]) nearest[index] = {patch, 0.0F};
  });
  std::vector<Vector3d> centroids;
  for (const geometry::SurfacePatch& patch : object.patches) centroids.push_back(patch.centroid);
  const auto visit = [&](const Vector3i& voxel, std::int64_t index) {
    Nearest& own = nearest[index];
    if (own.squared == 0.0F) return;
    const Vector3d center =
        lattice_.origin + lattice_.voxel_size * (voxel.cast<double>().array() + 0.5).matrix();
    for (int axis = 0; axis < 3; ++axis) {
      for (const int step : {-1, 1}) {
        if (voxel[axis] + step < 0 || voxel[axis] + step >= n[axis]) continue;
        const std::int32_t patch = nearest[index + step * strides[axis]].patch;
        if (patch < 0 || patch == own.patch) continue;
        const auto squared = static_cast<float>((center - centroids[patch]).squaredNorm());
        if (squared < own.squared) own = {patch, squared};
      }
    }
  };
  for (int round = 0; round < 2; ++round) {
    for_each_voxel(false, visit);
    for_each_voxel(true, visit);
  }
  for_each_voxel(false, [&](const Vector3i& voxel, std::int64_t index) {
    patch_of_voxel_[lattice_.index(voxel)] = nearest[index].patch;
  });
}

}  // namespace graspfit::grasp::internal
