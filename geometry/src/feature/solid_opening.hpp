#pragma once

#include <optional>
#include <vector>

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/voxel_grid.hpp"

namespace graspfit::geometry::internal {

/// The morphological opening of a solid by a ball: the voxels that a ball inside the solid can
/// reach, grown by a fillet.
struct SolidOpening {
  std::vector<char> is_opened;   ///< One per voxel.
  std::vector<float> to_center;  ///< Distance [voxels] to the nearest voxel that holds a ball's
                                 ///< center, where the voxel is not opened but next to one that
                                 ///< is; elsewhere at least that distance, or infinite.
};

/// Opens a solid by a ball of `radius` [m]; empty if no ball fits. `grid` holds the classes of the
/// solid's voxels. `find_weak_regions` explains what is approximate. Balls are only searched for
/// where they can change the result.
std::optional<SolidOpening> open_solid(const MeshQuery& object, const VoxelGrid& grid,
                                       double radius, int num_threads);

}  // namespace graspfit::geometry::internal
