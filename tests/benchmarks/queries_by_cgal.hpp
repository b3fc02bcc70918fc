#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <span>

#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::testing {

/// What CGAL answers about one closed mesh, as a program asks that uses CGAL alone: in its kernel
/// of exact predicates and double coordinates, with its `AABB_tree` of triangles that stand in a
/// row in memory, `Side_of_triangle_mesh` and `Polygon_mesh_processing`.
class QueriesByCgal {
 public:
  explicit QueriesByCgal(const geometry::TriangleMesh& mesh);
  ~QueriesByCgal();
  QueriesByCgal(const QueriesByCgal&) = delete;
  QueriesByCgal& operator=(const QueriesByCgal&) = delete;

  /// Builds the tree anew; with `for_distances` also the search tree of hints that CGAL makes for
  /// nearest points. Either is needed before the questions below.
  void build_tree(const geometry::TriangleMesh& mesh, bool for_distances);

  /// Distance to the nearest point, which is found together with its face. Needs the search tree.
  double distance(const Eigen::Vector3d& point) const;
  bool is_inside(const Eigen::Vector3d& point) const;
  bool does_hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  std::size_t num_hits(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  /// Faces that meet the box themselves, not only with their boxes.
  std::size_t num_faces_in(const Eigen::AlignedBox3d& box) const;
  std::size_t num_self_intersections() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether two closed meshes collide, one moved, by `Rigid_triangle_mesh_collision_detection`,
/// which moves boxes and triangles by itself. Both trees are built beforehand.
class CollisionByCgal {
 public:
  CollisionByCgal(const geometry::TriangleMesh& a, const geometry::TriangleMesh& b);
  ~CollisionByCgal();
  CollisionByCgal(const CollisionByCgal&) = delete;
  CollisionByCgal& operator=(const CollisionByCgal&) = delete;

  bool do_intersect(const geometry::RigidTransform& X_AB);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The union of closed meshes by `corefine_and_compute_union`, one after the other, with points
/// rounded to doubles.
class UnionByCgal {
 public:
  /// @throws InvalidInput without parts.
  explicit UnionByCgal(std::span<const geometry::TriangleMesh> parts);
  ~UnionByCgal();
  UnionByCgal(const UnionByCgal&) = delete;
  UnionByCgal& operator=(const UnionByCgal&) = delete;

  /// Unites copies of them, since the inputs are changed. Returns the number of faces.
  /// @throws DegenerateGeometry if CGAL refuses.
  std::size_t unite();

  /// Volume of the last union [m³].
  double volume() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Number of facets of the hull that `convex_hull_3` makes of the points.
std::size_t num_hull_facets_by_cgal(std::span<const Eigen::Vector3d> points);

}  // namespace graspfit::testing
