#pragma once

#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/rigid_transform.hpp"

namespace graspfit::grasp::internal {

/// Slack for the rounding of a box that is transformed to another frame [m]; with the coordinates
/// of a hand and its object the rounding is below 1e-14.
inline constexpr double kBoxSlack = 1e-9;

/// `geometry::distance` where it is below `enough` [m]; infinite, without points, where it is not.
/// Bodies whose boxes are farther apart cost next to nothing.
geometry::MeshDistance distance_up_to(const geometry::MeshQuery& a, const geometry::MeshQuery& b,
                                      const geometry::RigidTransform& X_AB, double enough);

}  // namespace graspfit::grasp::internal
