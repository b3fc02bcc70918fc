#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/voxel_grid.hpp"

namespace graspfit::geometry::internal {

/// Tells quickly how far points near a solid are outside of it: by the distance to the face that is
/// nearest to the center of the point's voxel. It serves to choose among many candidates, not to
/// decide anything exactly.
///
/// Approximate: never less than the distance to that face's solid side allows, and too large by at
/// most the spacing of the lattice, where another face is nearer. The nearest faces are found on
/// first use, without a lock: only one thread at a time may use an object.
class OutsideDepth {
 public:
  /// `resolution` voxels along the longest extent. The mesh is closed and outward.
  OutsideDepth(const MeshQuery& solid, int resolution);

  /// How far `point` is outside the solid [m]; zero inside.
  double operator()(const Eigen::Vector3d& point) const;

 private:
  MeshQuery solid_;
  const TriangleMesh* mesh_;  // of solid_
  VoxelLattice lattice_;
  mutable std::vector<std::int32_t> nearest_faces_;  // one per voxel center; −1: not yet
  std::vector<std::array<Eigen::Vector3d, 3>> face_corners_;
  std::vector<Eigen::Vector3d> face_normals_;                 // unit
  std::vector<std::array<Eigen::Vector3d, 3>> edge_normals_;  // edge k from corner k on
  std::vector<Eigen::Vector3d> vertex_normals_;
};

}  // namespace graspfit::geometry::internal
