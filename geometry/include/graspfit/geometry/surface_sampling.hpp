#pragma once

#include <cstdint>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// A point on a mesh.
struct SurfaceSample {
  Eigen::Vector3d point;   ///< Σ weight · corner [m]. Rounded.
  Eigen::Vector3d normal;  ///< Unit outward normal of the face.
  std::int32_t face = -1;
  Eigen::Vector3d barycentric;  ///< Weights of the face's corners, ≥ 0, sum 1 up to rounding.
  bool operator==(const SurfaceSample&) const = default;
};

/// How many points, and which.
struct SurfaceSamplingOptions {
  std::size_t count = 1000;  ///< Points wanted, ≤ 10 million.
  std::uint64_t seed = 0;    ///< Equal seeds give equal points.
  void validate() const;     ///< Throws InvalidInput naming the field and its value.
};

/// Independent points, uniform by area: each face gets points in proportion to its area, and within
/// a face all points are equally likely. Faces without area get none.
///
/// The k-th point depends on seed and k only, so that a smaller `count` gives the first points of a
/// larger one. Cost: linear in faces, log n per point.
/// @throws DegenerateGeometry if the mesh has no area; InvalidInput if it has numbers that are not
/// finite, or an index that is no vertex's.
std::vector<SurfaceSample> sample_surface(const TriangleMesh& mesh,
                                          const SurfaceSamplingOptions& options = {});

}  // namespace graspfit::geometry
