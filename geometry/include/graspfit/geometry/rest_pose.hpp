#pragma once

#include <Eigen/Core>
#include <vector>

#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// A way in which a rigid solid can lie on a plane.
struct RestPose {
  Eigen::Vector3d up_O;  ///< Unit: the direction of the solid's frame that is up.
  double height = 0.0;   ///< Of the center of mass above the plane [m].
  double margin = 0.0;   ///< Of the center's plumb point from the border of the support [m], ≥ 0.
};

/// Limits of `rest_poses`.
struct RestPoseOptions {
  double flatness = 1e-4;      ///< Corners of the convex hull this close to the plane support too
                               ///< [m], ≥ 0: scanned feet are never quite level.
  double same_up = 1e-3;       ///< Poses whose up differs by less are one [rad], ≥ 0.
  double least_margin = 1e-3;  ///< Others are left out: a touch would turn them over [m], ≥ 0.
  void validate() const;       ///< Throws InvalidInput naming the field and its value.
};

/// All ways in which a solid rests on a plane, the lowest center of mass first: those triangles of
/// its convex hull over which its center of mass is plumb. (The distance of the center from the
/// hull's surface has a local minimum just there; from any other facet the solid rolls on.) A
/// cylinder's side is as many rest poses as its mesh has facets there.
///
/// The hull is exact, the rest rounded; vertices of no face do not count. @throws InvalidInput for
/// bad options, a mesh without faces and a center that is not finite, DegenerateGeometry for a mesh
/// that spans no volume.
std::vector<RestPose> rest_poses(const TriangleMesh& mesh, const Eigen::Vector3d& center_of_mass,
                                 const RestPoseOptions& options = {});

/// The rest pose whose up is nearest to `wanted_up_O` (need not be unit), of equal ones the first.
/// @throws InvalidInput for a direction without length and where there is no rest pose.
const RestPose& nearest_rest_pose(const std::vector<RestPose>& poses,
                                  const Eigen::Vector3d& wanted_up_O);

/// The pose in W of a solid that stands on z = 0 with `up_O` up: its lowest vertex at height zero
/// up to rounding, `center_O` plumb over `place_W`; turned by the least rotation that brings up_O
/// up (about x where it points down), then by `turn` about z [rad]. `up_O` need not be unit;
/// vertices of no face do not count. @throws InvalidInput for a mesh without faces, an up without
/// length, and numbers that are not finite.
RigidTransform standing_pose(const TriangleMesh& mesh, const Eigen::Vector3d& up_O, double turn,
                             const Eigen::Vector3d& center_O, const Eigen::Vector2d& place_W);

}  // namespace graspfit::geometry
