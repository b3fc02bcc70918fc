#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "graspfit/geometry/mesh_query.hpp"

namespace graspfit::geometry {

struct SurfacePatch;

/// A regular lattice of cubic voxels. Voxel (i, j, k) has index i + nx (j + ny k): x fastest.
///
/// Voxel i along an axis lies between `plane(axis, i)` and `plane(axis, i + 1)`; each plane is one
/// double, rounded once, so that neighboring voxels share it exactly.
struct VoxelLattice {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< Lowest corner [m].
  double voxel_size = 0.0;                           ///< Edge length h [m], > 0.
  Eigen::Vector3i counts = Eigen::Vector3i::Zero();  ///< Voxels per axis.

  double plane(int axis, int i) const { return origin[axis] + voxel_size * i; }
  std::int64_t num_voxels() const { return std::int64_t{counts[0]} * counts[1] * counts[2]; }
  std::int64_t index(const Eigen::Vector3i& voxel) const {
    return voxel[0] + counts[0] * (voxel[1] + std::int64_t{counts[1]} * voxel[2]);
  }
  Eigen::Vector3i voxel(std::int64_t index) const;
  bool contains(const Eigen::Vector3i& voxel) const {
    return (voxel.array() >= 0).all() && (voxel.array() < counts.array()).all();
  }
  Eigen::Vector3d center(const Eigen::Vector3i& voxel) const {
    return origin + voxel_size * (voxel.cast<double>().array() + 0.5).matrix();
  }
  /// The voxel that holds `point`, perhaps outside the lattice. Approximate: the index is the floor
  /// of a rounded quotient; for a point within rounding of a plane it may be that of either
  /// neighbor. The point is finite, and no farther than 2^31 voxels.
  Eigen::Vector3i voxel_at(const Eigen::Vector3d& point) const {
    return ((point - origin) / voxel_size).array().floor().cast<int>();
  }
  bool operator==(const VoxelLattice&) const = default;
};

/// Where the lattice's resolution and extent come from.
struct LatticeOptions {
  /// Voxels along the longest extent of the box, in [4, 512]. The paper's 30.
  int resolution = 30;
  double margin = 0.0;    ///< Margin added on every side [m], ≥ 0, rounded up to whole voxels (at
                          ///< least 1).
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// A lattice with `resolution` voxels along the longest extent of `box`, the box centered in it,
/// grown by the margin on each side (paper section 3).
/// @throws DegenerateGeometry if the box is empty or has no extent.
/// @throws InvalidInput if it would hold more than 2^31 − 1 voxels.
VoxelLattice lattice_around(const Eigen::AlignedBox3d& box, const LatticeOptions& options);

/// Class of a voxel against a closed surface [Nooruddin & Turk 2003; paper section 3].
enum class VoxelClass : std::uint8_t {
  Empty,    ///< Wholly outside.
  Partial,  ///< Holds a piece of the surface of positive area.
  Full,     ///< Wholly inside.
};

/// Classes of all voxels of a lattice.
struct VoxelGrid {
  VoxelLattice lattice;
  std::vector<VoxelClass> classes;  ///< One per voxel, in index order.

  VoxelClass at(const Eigen::Vector3i& voxel) const { return classes[lattice.index(voxel)]; }
  std::int64_t count(VoxelClass voxel_class) const;
};

/// Classifies every voxel. `patches` are those of the same mesh and lattice.
///
/// Exact: a voxel is partial iff it has a patch (see SurfacePatch for the tie rule); the others
/// form 6-connected regions that the surface does not cross, and each region is full or empty by
/// the exact containment of one of its voxel centers.
VoxelGrid voxelize(const MeshQuery& object, const VoxelLattice& lattice,
                   const std::vector<SurfacePatch>& patches);

/// The same by the indices of the voxels that have a patch (`surface_voxels`).
VoxelGrid voxelize(const MeshQuery& object, const VoxelLattice& lattice,
                   std::span<const std::int64_t> partial_voxels);

}  // namespace graspfit::geometry
