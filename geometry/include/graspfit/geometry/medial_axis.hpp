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
  std::array<std::int32_t, 2> contact_faces{};  ///< Their faces.
  double object_angle_deg = 0.0;  ///< Between the directions from the center to the contacts.
};

/// Which balls are kept, and how they are found.
struct MedialBallOptions {
  double min_object_angle_deg = 120.0;  ///< Smaller angles come from bumps and noise; in [0, 180].
  double min_radius_rel = 0.0;          ///< Of the largest radius kept by the angle; in [0, 1].
                                        ///< Removes surface detail.
  double emptiness_tolerance = 0.05;  ///< A ball is empty when no surface is deeper in it than this
                                      ///< share of the radius to which it would shrink there; in
                                      ///< [1e-12, 0.1]. See `medial_balls`.
  int num_threads = 0;                ///< 0: all of the machine. The result does not depend on it.
  void validate() const;              ///< Throws InvalidInput naming the field and its value.
};

/// Inscribed balls by shrinking [Ma, Bae & Choi 2012], against the true surface instead of other
/// samples: at each sample a ball tangent to the surface from inside, at first of half the box's
/// diagonal, shrinks until no surface is inside it.
///
/// Object angle and filters as in the grid of medial spheres [Przybylski, Asfour & Dillmann 2011]:
/// angle above min_object_angle_deg, and radius above min_radius_rel times the largest radius that
/// passed the angle. Balls whose center is not inside (exact containment) go, and those that do not
/// come to rest within 100 steps.
///
/// Strictly, a ball tangent to a facet of a round body anywhere but in its middle is stopped by
/// facets beside it before it reaches the other side, and the angle rejects it: a polyhedron has a
/// branch of its medial axis to each convex edge. The tolerance lets balls pass facets that are
/// turned against each other by up to twice as much in radians (5.7° by default); on coarser ones
/// fewer samples have a ball. A sample's normal need not be its face's: with smoothed ones more
/// balls are kept.
///
/// The result is in the order of `samples`. Approximate: balls are empty to the stated tolerance
/// and touch the surface at both contacts to rounding. Cost: about ten closest points per sample.
/// @throws InvalidInput if a sample's face does not exist, its point is not finite, or its normal
/// is not unit within 1e-6. A zero normal, that of a face without area, has no ball.
std::vector<MedialBall> medial_balls(const MeshQuery& object,
                                     std::span<const SurfaceSample> samples,
                                     const MedialBallOptions& options = {});

}  // namespace graspfit::geometry
