#pragma once

#include <optional>
#include <vector>

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/voxel_grid.hpp"

namespace graspfit::geometry::internal {

/// A solid opened by a ball: which of its voxels a ball that rolls inside it reaches, with a
/// fillet.
struct SolidOpening {
  std::vector<char> is_opened;   ///< One per voxel.
  std::vector<float> to_center;  ///< Distance [voxels] to the nearest voxel that holds a ball's
                                 ///< center, where the voxel is not opened but next to one that
                                 ///< is; elsewhere at least that distance.
};

/// Opens a solid; empty if no ball fits. `grid` has its classes. See `find_weak_regions` for what
/// is approximate. Balls are only looked for where they can make a difference.
std::optional<SolidOpening> open_solid(const MeshQuery& object, const VoxelGrid& grid,
                                       double radius, int num_threads);

}  // namespace graspfit::geometry::internal
