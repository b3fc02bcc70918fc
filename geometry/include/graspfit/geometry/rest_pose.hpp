#pragma once

#include <Eigen/Core>
#include <vector>

#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// A pose in which a rigid solid can rest on a plane.
struct RestPose {
  Eigen::Vector3d up_O;  ///< Unit: the direction of the solid's frame that is up.
  double height = 0.0;   ///< Of the center of mass above the plane [m].
  double margin = 0.0;  ///< Distance of the center of mass, projected to the plane, from the border
                        ///< of the support polygon [m], ≥ 0.
};

/// Limits of `rest_poses`.
struct RestPoseOptions {
  double flatness = 1e-4;  ///< Corners of the convex hull this close to the plane support too
                           ///< [m], ≥ 0: scanned feet are never quite level.
  double same_up = 1e-3;   ///< Poses whose up vectors differ by less than this count as one [rad],
                           ///< ≥ 0.
  double least_margin = 1e-3;  ///< Poses with a smaller margin are left out, since a touch would
                               ///< tip them over [m], ≥ 0.
  void validate() const;       ///< Throws InvalidInput naming the field and its value.
};

/// All poses in which a solid rests on a plane, the lowest center of mass first. The solid rests on
/// those triangles of its convex hull that hold the projection of its center of mass along their
/// normal. (Exactly there the distance of the center from the hull's surface has a local minimum;
/// from any other facet the solid rolls on.) A cylinder's side gives as many rest poses as its mesh
/// has facets there.
///
/// The hull is exact, all other results are rounded; vertices that belong to no face do not count.
/// @throws InvalidInput for bad options, a mesh without faces and a center that is not finite,
/// DegenerateGeometry for a mesh that spans no volume.
std::vector<RestPose> rest_poses(const TriangleMesh& mesh, const Eigen::Vector3d& center_of_mass,
                                 const RestPoseOptions& options = {});

/// The rest pose whose up is nearest to `wanted_up_O` (need not be unit), of equal ones the first.
/// @throws InvalidInput for a direction without length and where there is no rest pose.
const RestPose& nearest_rest_pose(const std::vector<RestPose>& poses,
                                  const Eigen::Vector3d& wanted_up_O);

/// The pose in W of a solid that stands on z = 0 with `up_O` pointing up. Its lowest vertex is at
/// height zero up to rounding, and `center_O` is vertically above `place_W`. The rotation is the
/// least one that makes up_O point up (about x where up_O points down), followed by the angle
/// `turn` about z [rad]. `up_O` need not be unit; vertices that belong to no face do not count.
/// @throws InvalidInput for a mesh without faces, an up without length, and numbers that are not
/// finite.
RigidTransform standing_pose(const TriangleMesh& mesh, const Eigen::Vector3d& up_O, double turn,
                             const Eigen::Vector3d& center_O, const Eigen::Vector2d& place_W);

}  // namespace graspfit::geometry
