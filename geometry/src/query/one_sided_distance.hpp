#pragma once

#include <array>
#include <vector>

#include "graspfit/geometry/surface_distance.hpp"

namespace graspfit::geometry::internal {

/// Bounds of the greatest distance of a point of some triangles from a surface.
struct OneSidedDistance {
  double lower = 0.0;
  double upper = 0.0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< On the triangles; attains `lower`.
  Eigen::Vector3d nearest = Eigen::Vector3d::Zero();  ///< On the surface.
};

/// Bounds of the greatest distance of a point of `triangles` from `surface`. Triangles may be
/// degenerate; without triangles the bounds are zero.
OneSidedDistance one_sided_distance(const std::vector<std::array<Eigen::Vector3d, 3>>& triangles,
                                    const MeshQuery& surface, const HausdorffOptions& options);

/// The triangles of the given faces.
std::vector<std::array<Eigen::Vector3d, 3>> triangles_of(
    const std::vector<Eigen::Vector3d>& vertices, const std::vector<Face>& faces);

}  // namespace graspfit::geometry::internal
