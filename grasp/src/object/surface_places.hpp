#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "graspfit/grasp/object_model.hpp"

namespace graspfit::grasp::internal {

/// A place of an object's surface on which a pad may lie [R].
struct SurfacePlace {
  Eigen::Vector3d point_O = Eigen::Vector3d::Zero();           ///< On the surface [m].
  Eigen::Vector3d outward_normal_O = Eigen::Vector3d::Zero();  ///< Unit; zero where there is none.
  bool has_normal = false;
  std::int32_t patch = -1;       ///< Index into `ObjectModel::patches`.
  std::int32_t other_side = -1;  ///< Index of the place behind it in a thin wall; −1: no such wall.
};

/// The object's patches as places, in their order. Where a wall, a fin or a tube is so thin that
/// both of its sides are in one voxel, whose mean normal says nothing, the patch's place is one
/// side, and the other one is among further places that follow: on walls, where at least half of
/// the surface in 5 x 5 x 5 voxels about it faces as each side does, and not on rims [R].
/// @param splits_walls false: patches as they are, none follow
std::vector<SurfacePlace> surface_places(const ObjectModel& object, bool splits_walls);

}  // namespace graspfit::grasp::internal
