#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/surface_sampling.hpp"

namespace graspfit::geometry {

/// A ball inside a solid that touches its surface at two points: a point of its medial axis.
struct MedialBall {
  Eigen::Vector3d center;                   ///< [m]
  double radius = 0.0;                      ///< [m]
  std::array<Eigen::Vector3d, 2> contacts;  ///< The sample, and the point that stopped the ball.
  std::array<std::int32_t, 2> contact_faces{};  ///< Faces on which the contacts lie.
  double object_angle_deg = 0.0;  ///< Between the directions from the center to the contacts.
};

/// Which balls are kept, and how they are found.
struct MedialBallOptions {
  double min_object_angle_deg = 120.0;  ///< Balls with smaller object angles are dropped, as they
                                        ///< come from bumps and noise; in [0, 180].
  double min_radius_rel = 0.0;  ///< Least radius over the largest radius of the balls that pass
                                ///< the other tests; in [0, 1]. It removes surface detail.
  double emptiness_tolerance = 0.05;  ///< A ball counts as empty if no point of the surface is
                                      ///< deeper in it than this share of the radius to which that
                                      ///< point would shrink the ball; in [1e-12, 0.1]. See
                                      ///< `medial_balls`.
  int num_threads = 0;                ///< 0: all of the machine. The result does not depend on it.
  void validate() const;              ///< Throws InvalidInput naming the field and its value.
};

/// Finds inscribed balls by shrinking [Ma, Bae & Choi 2012], tested against the true surface
/// instead of other samples: at each sample a ball tangent to the surface from inside, with half
/// the box's diagonal as its first radius, shrinks until no surface is inside it.
///
/// Object angle and filters are those of the grid of medial spheres [Przybylski, Asfour & Dillmann
/// 2011]. Balls that still shrink after 100 steps are dropped, and so are balls whose angle is not
/// above min_object_angle_deg or whose center is not inside the solid (by exact containment). Of
/// the others those are kept whose radius is above min_radius_rel times the largest radius.
///
/// Without a tolerance, a ball tangent to a facet of a round body anywhere but in the facet's
/// middle would be stopped by neighboring facets before it reaches the other side of the body, and
/// the angle test would reject it: the medial axis of a polyhedron has a branch to each convex
/// edge. `emptiness_tolerance` lets balls pass neighboring facets whose normals differ by up to
/// twice the tolerance in radians (5.7° by default); on coarser meshes fewer samples have a ball. A
/// sample's normal need not be that of its face: with smoothed normals more balls are kept.
///
/// The result is in the order of `samples`. Approximate: balls are empty to the stated tolerance
/// and touch the surface at both contacts to rounding. Cost: about ten closest points per sample.
/// @throws InvalidInput if a sample's face does not exist, its point is not finite, or its normal
/// is not unit within 1e-6. A sample with a zero normal, as on a face without area, has no ball.
std::vector<MedialBall> medial_balls(const MeshQuery& object,
                                     std::span<const SurfaceSample> samples,
                                     const MedialBallOptions& options = {});

}  // namespace graspfit::geometry
