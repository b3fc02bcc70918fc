#pragma once

#include <limits>

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/rigid_transform.hpp"

namespace graspfit::geometry {

/// Whether two closed solids share a point: their surfaces touch or cross, or one holds the other.
///
/// Exact on the vertices of `b` mapped to frame A by `X_AB` and rounded once (exactly the mesh
/// `transformed(b.mesh(), X_AB)`).
/// @throws InvalidInput for a pose that is not finite, as all functions of this header.
bool do_intersect(const MeshQuery& a, const MeshQuery& b, const RigidTransform& X_AB);

/// How deep two solids overlap.
struct Penetration {
  bool intersects = false;   ///< As `do_intersect`: exact.
  double depth = 0.0;        ///< [m] Deepest point found; a lower bound of the true depth. Zero if
                             ///< they do not intersect.
  double depth_bound = 0.0;  ///< [m] The true depth is at most this.
  Eigen::Vector3d deepest_point_A = Eigen::Vector3d::Zero();
};

/// Limits of `penetration`.
struct PenetrationOptions {
  double tolerance = 1e-5;  ///< Stop when depth_bound − depth is below this [m], > 0.
  double enough = std::numeric_limits<double>::infinity();  ///< Stop when depth is above this [m],
                                                            ///< ≥ 0: larger depths need not be told
                                                            ///< apart.
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// Depth of the overlap: the larger of the greatest distance to A's surface over the points of B's
/// surface that lie inside A, and the same with A and B exchanged.
///
/// Branch and bound over triangles (the distance to a surface is 1-Lipschitz), so that the answer
/// does not depend on how finely either mesh is tessellated. The search ends when the tolerance is
/// met, when `enough` is exceeded, or after 50 000 steps in each of the two directions (as for wide
/// overlaps of finely tessellated curved surfaces); both bounds hold in all cases, up to 1e-11 of
/// the coordinates. Cost: that of `do_intersect` if the solids do not intersect.
Penetration penetration(const MeshQuery& a, const MeshQuery& b, const RigidTransform& X_AB,
                        const PenetrationOptions& options = {});

/// Bounds of the depth of an overlap as `penetration` defines it.
struct DepthBounds {
  double at_least = 0.0;  ///< [m] Deepest point found that is deeper than the floor; else zero.
  double at_most = 0.0;   ///< [m] No point is deeper.
};

/// How deep two solids overlap, where depths up to `floor` [m] ≥ 0 need not be told apart:
/// `at_most` is then the floor or little more. The search ends as that of `penetration`, and is
/// much cheaper, since it visits only what may be deeper than the floor.
DepthBounds depth_above(const MeshQuery& a, const MeshQuery& b, const RigidTransform& X_AB,
                        double floor, const PenetrationOptions& options = {});

/// Smallest distance between two surfaces that do not intersect, with witness points [m].
struct MeshDistance {
  double distance = 0.0;         ///< Zero if the solids intersect.
  Eigen::Vector3d point_on_a_A;  ///< Meaningless (the origin) if the solids intersect.
  Eigen::Vector3d point_on_b_A;  ///< As `point_on_a_A`.
};

/// Smallest distance between the surfaces of two solids. Whether the solids intersect is decided
/// exactly, as by `do_intersect`; distance and points are approximate, as those of
/// `nearest_points`.
MeshDistance distance(const MeshQuery& a, const MeshQuery& b, const RigidTransform& X_AB);

}  // namespace graspfit::geometry
