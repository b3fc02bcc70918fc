#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "graspfit/base/as_index.hpp"
#include "graspfit/geometry/voxel_grid.hpp"
#include "voxel/block.hpp"

namespace graspfit::geometry::internal {

using Index = std::int64_t;  ///< Of a voxel in its lattice.

/// Calls visit(neighbor) for the other voxels of the 3 × 3 × 3 block around a voxel, as far as the
/// lattice has them.
template <typename Visit>
void for_each_neighbor(const VoxelLattice& lattice, Index index, const Visit& visit) {
  const Eigen::Vector3i voxel = lattice.voxel(index);
  const Eigen::Vector3i low = (voxel.array() - 1).max(0);
  const Eigen::Vector3i high = (voxel.array() + 1).min(lattice.counts.array() - 1);
  for_each_in_block(low, high, [&](const Eigen::Vector3i& other) {
    const Index neighbor = lattice.index(other);
    if (neighbor != index) visit(neighbor);
  });
}

/// Labels the 26-connected sets of voxels for which `is_member`, in order of their first voxel;
/// −1 for the others. Returns the sets' voxels.
template <typename IsMember>
std::vector<std::vector<Index>> label_sets(const VoxelLattice& lattice,
                                           const std::vector<Index>& solid,
                                           const IsMember& is_member,
                                           std::vector<std::int32_t>& label) {
  std::vector<std::vector<Index>> sets;
  for (const Index first : solid) {
    if (label[first] >= 0 || !is_member(first)) continue;
    const auto name = base::as_index<std::int32_t>(sets.size());
    std::vector<Index> set = {first};
    label[first] = name;
    for (std::size_t next = 0; next < set.size(); ++next) {
      for_each_neighbor(lattice, set[next], [&](Index neighbor) {
        if (label[neighbor] >= 0 || !is_member(neighbor)) return;
        label[neighbor] = name;
        set.push_back(neighbor);
      });
    }
    sets.push_back(std::move(set));
  }
  return sets;
}

/// Clears all members but those of the largest 26-connected set; of equal ones that with the first
/// voxel. Cost: linear in the voxels.
void keep_largest_set(const VoxelLattice& lattice, std::vector<char>& is_member);

/// Topology of a set of voxels taken as closed cubes.
struct SetTopology {
  int num_pieces = 0;
  int num_rings = 0;  ///< Independent loops: 1 for a ring, 0 for a disk.
};

/// Topology of a set of voxels, each grown by `growth` voxels to all sides, which closes narrower
/// gaps and holes. It follows from the numbers of cubes, faces, edges and corners by Euler's
/// formula: pieces − rings + cavities = χ.
SetTopology topology(const VoxelLattice& lattice, const std::vector<Index>& voxels, int growth);

/// Distance [voxels] from the body to the farthest voxel of a set, along shortest paths inside the
/// set. `starts` are the voxels next to the body with their distances from it.
class LongestWay {
 public:
  LongestWay(const VoxelLattice& lattice, const std::vector<std::int32_t>& label)
      : lattice_(lattice),
        label_(label),
        length_(label.size(), std::numeric_limits<float>::infinity()) {}

  double operator()(std::int32_t name, const std::vector<std::pair<float, Index>>& starts);

  /// Distance [voxels] from the body to a voxel of a set for which operator() has been called.
  float length_at(Index voxel) const { return length_[voxel]; }

 private:
  /// The index of a voxel, if it is of the set with this name.
  std::optional<Index> member(const Eigen::Vector3i& voxel, std::int32_t name) const {
    if (!lattice_.contains(voxel)) return std::nullopt;
    const Index index = lattice_.index(voxel);
    return label_[index] == name ? std::optional(index) : std::nullopt;
  }

  const VoxelLattice& lattice_;
  const std::vector<std::int32_t>& label_;
  std::vector<float> length_;
};

}  // namespace graspfit::geometry::internal
