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
/// a face all places are equally likely. Faces without area get none.
///
/// The k-th point depends on seed and k only: fewer points are the beginning of more.
/// Cost: linear in faces, log n per point.
/// @throws DegenerateGeometry if the mesh has no area.
std::vector<SurfaceSample> sample_surface(const TriangleMesh& mesh,
                                          const SurfaceSamplingOptions& options = {});

/// Points that keep a distance from each other.
struct EvenSamplingOptions {
  double min_distance = 0.0;      ///< Least straight distance of two points [m], > 0.
  int num_trials_per_point = 30;  ///< Darts thrown for every point that would fit if points
                                  ///< were packed as densely as disks can be; in [1, 10000].
                                  ///< More leave smaller gaps.
  std::uint64_t seed = 0;         ///< Equal seeds give equal points.
  void validate() const;          ///< Throws InvalidInput naming the field and its value.
};

/// Evenly spread points (blue noise) by throwing darts: uniform points are taken one after the
/// other, and one is kept if no kept one is nearer than `min_distance` [Cook 1986].
///
/// Distances are straight ones: thin walls are covered from one side or the other. That no two
/// points are nearer is exact on the rounded points; that no gap is left is not promised.
/// Cost: linear in faces and darts.
/// @throws DegenerateGeometry if the mesh has no area.
/// @throws InvalidInput if more than 100 million darts would be needed.
std::vector<SurfaceSample> sample_surface_evenly(const TriangleMesh& mesh,
                                                 const EvenSamplingOptions& options);

}  // namespace graspfit::geometry
