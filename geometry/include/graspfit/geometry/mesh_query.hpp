#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

/// Where a point lies against a closed surface.
enum class Containment { Inside, OnSurface, Outside };

/// The point of a mesh nearest to a query point.
struct ClosestPoint {
  Eigen::Vector3d point;        ///< [m]. Rounded.
  double squared_distance = 0;  ///< [m²]
  std::int32_t face = -1;
};

/// First hit of a ray.
struct RayHit {
  Eigen::Vector3d point;  ///< [m]. Rounded.
  double distance = 0;    ///< Along the unit direction [m].
  std::int32_t face = -1;
};

/// Spatial queries against one mesh; builds a box tree once and keeps a copy of the mesh.
///
/// Copies share the tree. All members are const and safe to call from several threads.
class MeshQuery {
 public:
  /// @throws InvalidInput if the mesh has no faces.
  explicit MeshQuery(TriangleMesh mesh);

  const TriangleMesh& mesh() const;

  /// Box of all faces. Exact.
  const Eigen::AlignedBox3d& box() const;

  /// Nearest surface point. Approximate to rounding (double constructions).
  ClosestPoint closest_point(const Eigen::Vector3d& point) const;

  /// Exact for closed meshes: inside is where the winding number of the surface is not zero,
  /// counted by the signed crossings of one ray with exact predicates. So parts that overlap are
  /// united, an outward part inside another changes nothing, and an inward part inside an outward
  /// one is a cavity. For an open mesh the answer depends on the ray.
  Containment containment(const Eigen::Vector3d& point) const;

  /// Distance to the surface, negative inside; sign exact, magnitude rounded.
  double signed_distance(const Eigen::Vector3d& point) const;

  /// First hit from `origin` along `direction` (need not be unit; zero throws InvalidInput).
  std::optional<RayHit> first_hit(const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction) const;

  /// Indices of all faces whose bounding box meets `box`, ascending. Exact on the given doubles.
  std::vector<std::int32_t> faces_near(const Eigen::AlignedBox3d& box) const;

  struct Impl;  ///< The tree; defined in the source.
  const Impl& impl() const { return *impl_; }

 private:
  std::shared_ptr<const Impl> impl_;
};

}  // namespace graspfit::geometry
