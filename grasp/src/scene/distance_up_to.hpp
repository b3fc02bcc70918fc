#pragma once

#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/rigid_transform.hpp"

namespace graspfit::grasp::internal {

/// Room for the rounding of a box seen from another frame [m]: of coordinates of a hand and its
/// object, below 1e-14.
inline constexpr double kBoxSlack = 1e-9;

/// `geometry::distance` where it is below `enough` [m]; infinite, without points, where it is not.
/// Bodies whose boxes are farther apart cost next to nothing.
geometry::MeshDistance distance_up_to(const geometry::MeshQuery& a, const geometry::MeshQuery& b,
                                      const geometry::RigidTransform& X_AB, double enough);

}  // namespace graspfit::grasp::internal
