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
  std::int32_t face_a = -1;  ///< Face of A that holds point_on_a_A.
  std::int32_t face_b = -1;
};

/// A pair of faces expected to be near each other, such as those of the last call: the search then
/// starts with a good bound. A seed changes the time only, except for ties, and except where
/// `near_enough` above 0 or a `share` below 1 lets the search end early.
struct ProximitySeed {
  std::int32_t face_a = 0;
  std::int32_t face_b = 0;
};

/// Nearest points of two surfaces as they are: surfaces may be open, and a surface inside a closed
/// one has a distance from it. Empty if the surfaces are no nearer to each other than `enough` [m].
///
/// Where only a yes or no is needed, the search may end early: it ends with the first pair of
/// points that is no farther apart than `near_enough` [m], even if another pair is nearer. The
/// result is approximate, to 1e-12 of the coordinates, however thin faces are; surfaces that cross
/// have distance zero, except for crossings as small as rounding. Where intersection matters use
/// `do_intersect`, which is exact.
/// @throws InvalidInput for a pose that is not finite, a limit that is not a number and a seed that
/// is not of these meshes.
std::optional<SurfaceProximity> nearest_points(const MeshQuery& a, const MeshQuery& b,
                                               const RigidTransform& X_AB, double enough,
                                               const std::optional<ProximitySeed>& seed = {},
                                               double near_enough = 0.0);

/// What a search for a lower bound finds.
struct SurfaceClearance {
  double at_least = 0.0;  ///< The bound [m].
  /// A pair of faces near each other as seed of the next search; if none was found, the given seed.
  std::optional<ProximitySeed> nearest;
};

/// A lower bound of the distance d between two surfaces [m], for proofs that bodies stay apart. The
/// bound is at least min(share d, `enough`) and at most min(d, `enough`), up to 1e-12 of the
/// coordinates, however thin faces are. It is zero or below rounding where the surfaces cross.
/// Whether one body encloses the other is not tested.
///
/// `share` in (0, 1] is the share of the distance that suffices; 1 asks for the distance itself.
/// The function is cheaper than `nearest_points`: bounds of parts of the surfaces suffice for the
/// pairs of faces that remain.
/// @throws InvalidInput as `nearest_points`, and for another `share`.
SurfaceClearance surface_clearance(const MeshQuery& a, const MeshQuery& b,
                                   const RigidTransform& X_AB, double enough, double share,
                                   const std::optional<ProximitySeed>& seed = {});

}  // namespace graspfit::geometry
