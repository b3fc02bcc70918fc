#pragma once

#include <cstdint>
#include <optional>

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/rigid_transform.hpp"

namespace graspfit::geometry {

/// Nearest points of two surfaces.
struct SurfaceProximity {
  double distance = 0.0;  ///< [m]; zero where the surfaces cross.
  Eigen::Vector3d point_on_a_A = Eigen::Vector3d::Zero();
  Eigen::Vector3d point_on_b_A = Eigen::Vector3d::Zero();
  std::int32_t face_a = -1;  ///< Of A, the face with its point.
  std::int32_t face_b = -1;
};

/// A pair of faces expected to be near each other, such as those of the last call: the search then
/// starts with a good bound. It changes the time only, but for ties.
struct ProximitySeed {
  std::int32_t face_a = -1;  ///< −1: none.
  std::int32_t face_b = -1;
};

/// Nearest points of two surfaces as they are: open ones too, and a surface inside a closed one has
/// a distance from it. Empty if they are no nearer than `enough` [m].
///
/// For a yes or no the search may end early: with the first pair of points that is no farther apart
/// than `near_enough` [m], whether or not another is nearer. Approximate, to the rounding of
/// distances; surfaces that cross have distance zero but for crossings as small as rounding. Where
/// intersection matters ask `do_intersect`, which is exact.
std::optional<SurfaceProximity> nearest_points(const MeshQuery& a, const MeshQuery& b,
                                               const RigidTransform& X_AB, double enough,
                                               const ProximitySeed& seed = {},
                                               double near_enough = 0.0);

/// What a search for a lower bound finds.
struct SurfaceClearance {
  double at_least = 0.0;  ///< The bound [m].
  ProximitySeed nearest;  ///< Faces near each other, for the next search; else the last seed.
};

/// A lower bound of the distance d between two surfaces [m], for proofs that bodies stay apart: at
/// least min(share d, `enough`), at most min(d, `enough`), up to 1e-12 of the coordinates. Zero or
/// below rounding where the surfaces cross. Whether one body holds the other is not asked.
///
/// `share` in (0, 1] says how much of the distance will do; 1 asks for all of it. Cheaper than
/// `nearest_points`: boxes alone bound what is left.
SurfaceClearance surface_clearance(const MeshQuery& a, const MeshQuery& b,
                                   const RigidTransform& X_AB, double enough, double share,
                                   const ProximitySeed& seed = {});

}  // namespace graspfit::geometry
