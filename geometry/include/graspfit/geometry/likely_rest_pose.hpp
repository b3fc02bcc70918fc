#pragma once

#include <Eigen/Core>
#include <vector>

#include "graspfit/geometry/rest_pose.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// A rest pose, and how often a solid that falls onto a plane comes to rest there.
struct LikelyRestPose {
  RestPose pose;
  double probability = 0.0;  ///< In [0, 1]; those of all poses sum to 1.
};

/// Limits of `likely_rest_poses`.
struct LikelyRestPoseOptions {
  /// Lift of the center of mass [m], ≥ 0, finite: rest poses from which the solid gets into a lower
  /// one by less count as that one, so that a can lies on its side once, not on each of its facets,
  /// and a scanned foot is one foot.
  double least_lift = 5e-4;
  double flatness = 1e-4;  ///< As `RestPoseOptions::flatness`, of the margins.
  void validate() const;   ///< Throws InvalidInput naming the field and its value.
};

/// The rest poses of a solid on a plane, the likeliest first, for a solid that is let go in any
/// orientation and rolls without a swing: it meets the plane with the facet of its convex hull that
/// is below its center of mass, and tips over the edge beyond which that center is until it rests.
/// The probability of a facet is the solid angle under which it is seen from the center of mass
/// over 4π (Goldberg, Mirtich, Zhuang, Craig, Carlisle, Canny, Part pose statistics: estimators and
/// experiments, IEEE Trans. Robotics and Automation 15(5), 1999, section III). Of poses that count
/// as one, the lowest is given.
///
/// The hull is exact, all other results are rounded; vertices that belong to no face do not count.
/// @throws InvalidInput for bad options, a mesh without faces and a center of mass that is not
/// inside the convex hull, DegenerateGeometry for a mesh that spans no volume.
std::vector<LikelyRestPose> likely_rest_poses(const TriangleMesh& mesh,
                                              const Eigen::Vector3d& center_of_mass,
                                              const LikelyRestPoseOptions& options = {});

}  // namespace graspfit::geometry
