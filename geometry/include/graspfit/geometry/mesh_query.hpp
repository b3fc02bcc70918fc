#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::geometry {

namespace internal {
class IndexedMesh;
}

/// Where a point lies against a closed surface.
enum class Containment { Inside, OnSurface, Outside };

/// The point of a mesh nearest to a query point.
struct ClosestPoint {
  Eigen::Vector3d point;        ///< [m]. Rounded.
  double squared_distance = 0;  ///< [m²]
  std::int32_t face = -1;
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();  ///< Weights of the face's corners, ≥ 0,
                                                          ///< sum 1 up to rounding.
};

/// Where a line meets a face.
struct RayHit {
  Eigen::Vector3d point;  ///< [m]. Rounded.
  double distance = 0;    ///< Along the unit direction [m]; negative behind the origin of a line.
  std::int32_t face = -1;
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();  ///< Weights of the face's corners, ≥ 0,
                                                          ///< sum 1 up to rounding; exactly zero
                                                          ///< where the line meets an edge.
  int crossing = 0;  ///< +1: the line leaves through the front of the face, −1: it enters, 0: the
                     ///< line, moved as `MeshQuery::all_hits` explains, misses the face. Exact.
};

/// How far a line goes.
enum class LineKind {
  Ray,   ///< From the origin on.
  Line,  ///< Both ways.
};

/// Spatial queries against one mesh, of which it keeps a copy. They walk a `CGAL::AABB_tree`, which
/// the first of them builds; exact decisions are those of CGAL's kernel.
///
/// Copies share the tree. All members are const and safe to call from several threads.
class MeshQuery {
 public:
  /// @throws InvalidInput if the mesh has no faces, a coordinate is not finite or a face has a
  /// vertex that is none. The other members throw it for points and boxes that are not numbers.
  explicit MeshQuery(TriangleMesh mesh);

  const TriangleMesh& mesh() const;

  /// Builds now what the first query of each kind would build, on two threads, about 1 µs a face:
  /// where the first answer must not be late, or times are taken.
  void build() const;

  /// Box of all faces. Exact.
  const Eigen::AlignedBox3d& box() const;

  /// Nearest surface point. Approximate (double constructions): the distance is too large by at
  /// most 2.3e-13 of the longest edge of a face, however thin faces are, and by the rounding of
  /// coordinates. Of faces at the same rounded distance the one with the lowest index.
  /// @throws InvalidInput where squared distances overflow, too.
  ClosestPoint closest_point(const Eigen::Vector3d& point) const;

  /// The same answer, sooner where face number `first`, which is looked at first, is among the
  /// near ones: the face of a point nearby.
  /// @throws InvalidInput for a face that there is not, too.
  ClosestPoint closest_point(const Eigen::Vector3d& point, std::int32_t first) const;

  /// Exact for closed meshes: inside is where the winding number of the surface is not zero,
  /// counted by the signed crossings of one ray with exact predicates. So parts that overlap are
  /// united, an outward part inside another changes nothing, and an inward part inside an outward
  /// one is a cavity. For an open mesh the answer depends on the ray.
  Containment containment(const Eigen::Vector3d& point) const;

  /// As `closest_point`, negative inside: the sign is exact, but a distance may round to zero.
  double signed_distance(const Eigen::Vector3d& point) const;

  /// First hit from `origin` along `direction` (need not be unit; zero throws InvalidInput): the
  /// first of `all_hits`. Cost: about log n.
  std::optional<RayHit> first_hit(const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction) const;

  /// Every face whose closed triangle the line meets, by distance, then by face.
  ///
  /// Which faces are hit is decided exactly, for the line through `origin` and a point far ahead of
  /// `origin` that is rounded once. A line through an edge meets the faces on both sides of the
  /// edge, a line through a vertex all faces around the vertex, at equal distances up to rounding.
  /// A face in whose plane the line runs is no hit (its neighbors are). A ray that starts on a face
  /// hits it at distance 0. Distances are rounded, to 2e-12 of the mesh's diagonal and of its
  /// distance from the origin, also for faces that are thin or seen edge-on.
  ///
  /// To count each crossing of the surface once, add up `crossing`. It is found by symbolic
  /// perturbation: the line counts as moved sideways by an infinitesimal step, so that it passes
  /// through the interior of faces only; a hit of a face that the moved line misses has crossing 0.
  /// Over a whole line and a closed mesh the sum is 0; over a ray it is the winding number at the
  /// ray's origin, if the origin is not on the surface.
  ///
  /// @throws InvalidInput if the direction has no length or anything is not finite.
  std::vector<RayHit> all_hits(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                               LineKind kind = LineKind::Ray) const;

  /// Indices of all faces whose bounding box meets `box`, ascending. Exact on the given doubles.
  std::vector<std::int32_t> faces_near(const Eigen::AlignedBox3d& box) const;

  /// The mesh and its tree, for this library's own use.
  const internal::IndexedMesh& indexed() const { return *indexed_; }

 private:
  std::shared_ptr<const internal::IndexedMesh> indexed_;
};

}  // namespace graspfit::geometry
