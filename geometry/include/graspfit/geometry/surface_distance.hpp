#pragma once

#include "graspfit/geometry/mesh_query.hpp"

namespace graspfit::geometry {

/// Bounds of the Hausdorff distance between two surfaces, with the pair that attains the lower one.
struct HausdorffDistance {
  double lower = 0.0;          ///< [m] Lower bound, attained by the two points below.
  double upper = 0.0;          ///< [m] Proven upper bound.
  Eigen::Vector3d point_on_a;  ///< [m]
  Eigen::Vector3d point_on_b;  ///< [m] One of the two points is nearest to the other.
};

/// Limits of `hausdorff_distance`.
struct HausdorffOptions {
  double tolerance = 1e-5;  ///< Stop when upper − lower is below this [m], > 0.
  int max_steps = 200'000;  ///< Most triangles that are quartered in each of the two directions,
                            ///< >= 0; then the bounds are returned as they are.
  void validate() const;    ///< Throws InvalidInput naming the field and its value.
};

/// The greatest distance of a point of either surface from the other surface.
///
/// Branch and bound over triangles (the distance to a surface is 1-Lipschitz, and the distance to
/// one face of it is convex), so that the answer does not depend on how finely either mesh is
/// tessellated [after Tang, Lee & Kim 2009]. The lower bound is as approximate as
/// `MeshQuery::closest_point`; the upper one is enlarged by 2e-14 of the coordinates to allow for
/// rounding. Cost: a closest-point query per face of both, and four per step.
HausdorffDistance hausdorff_distance(const MeshQuery& a, const MeshQuery& b,
                                     const HausdorffOptions& options = {});

}  // namespace graspfit::geometry
