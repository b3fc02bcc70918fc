#pragma once

#include <CGAL/version.h>
#if CGAL_VERSION_NR >= 1060000000
#include <CGAL/AABB_traits_3.h>
#else
#include <CGAL/AABB_traits.h>
#endif
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <utility>

#include "graspfit/geometry/triangle_mesh.hpp"
#include "query/indexed_triangle.hpp"

namespace graspfit::geometry::internal {

/// A triangle as `CGAL::AABB_tree` holds it: a model of its concept AABBPrimitive whose datum is
/// the primitive itself.
class FacePrimitive {
 public:
  using Id = std::int32_t;
  using Datum = FacePrimitive;
  using Datum_reference = const FacePrimitive&;
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  using Point_reference = Point;

  FacePrimitive() = default;
  explicit FacePrimitive(const IndexedTriangle& triangle) : triangle_(triangle) {}

  Id id() const { return triangle_.face; }
  Datum_reference datum() const { return *this; }
  /// Where the triangle is, when nodes are split: three times its centroid.
  Point reference_point() const {
    const auto& [a, b, c] = triangle_.corners;
    return {a.x() + b.x() + c.x(), a.y() + b.y() + c.y(), a.z() + b.z() + c.z()};
  }
  CGAL::Bbox_3 bbox() const {
    const Eigen::AlignedBox3d box = box_of(triangle_.corners);
    return {box.min().x(), box.min().y(), box.min().z(),
            box.max().x(), box.max().y(), box.max().z()};
  }

  const IndexedTriangle& triangle() const { return triangle_; }

 private:
  IndexedTriangle triangle_;
};

/// CGAL's tree of boxes over the faces of one mesh, walked by traversals of our own: CGAL's queries
/// know neither which of equally near faces is the first nor exact crossings of a ray. Boxes are
/// exact. Const members are safe to call from several threads.
class FaceTree {
 public:
  explicit FaceTree(const TriangleMesh& mesh);

  /// Calls visit(triangle) for all triangles in leaves that are reached through boxes for which
  /// enter(box) holds, in the order of the tree. Some are visited whose own box was never asked
  /// for.
  template <typename Enter, typename Visit>
  void traverse(const Enter& enter, const Visit& visit) const {
    Walk<Enter, Visit> walk{enter, visit};
    tree_.traversal(0, walk);
  }

  /// Calls visit(triangle) for triangles for whose boxes bound(box) ≤ limit() at that moment; of
  /// two nodes the one with the smaller bound comes first. `limit` may fall meanwhile. `bound` is
  /// never NaN, and never smaller for a box than for one around it.
  template <typename Bound, typename Limit, typename Visit>
  void traverse_by_bound(const Bound& bound, const Limit& limit, const Visit& visit) const {
    WalkByBound<Bound, Limit, Visit> walk{bound, limit, visit};
    tree_.traversal_with_priority(0, walk);
  }

  /// Calls visit(triangle) for all triangles whose boxes meet `box`. Exact.
  template <typename Visit>
  void traverse_near(const Eigen::AlignedBox3d& box, const Visit& visit) const {
    traverse([&](const Eigen::AlignedBox3d& node) { return box.intersects(node); },
             [&](const IndexedTriangle& triangle) {
               if (box.intersects(box_of(triangle.corners))) visit(triangle);
             });
  }

 private:
#if CGAL_VERSION_NR >= 1060000000
  using Traits =
      CGAL::AABB_traits_3<CGAL::Exact_predicates_inexact_constructions_kernel, FacePrimitive>;
#else
  using Traits =
      CGAL::AABB_traits<CGAL::Exact_predicates_inexact_constructions_kernel, FacePrimitive>;
#endif
  using Node = CGAL::AABB_node<Traits>;

  static Eigen::AlignedBox3d box_of_node(const Node& node) {
    const CGAL::Bbox_3& box = node.bbox();
    return {Eigen::Vector3d(box.xmin(), box.ymin(), box.zmin()),
            Eigen::Vector3d(box.xmax(), box.ymax(), box.zmax())};
  }

  // What CGAL asks of the traits of a traversal; its query is not used.
  template <typename Enter, typename Visit>
  struct Walk {
    const Enter& enter;
    const Visit& visit;
    bool go_further() const { return true; }
    bool do_intersect(int, const Node& node) const { return enter(box_of_node(node)); }
    void intersection(int, const FacePrimitive& face) const { visit(face.triangle()); }
  };

  template <typename Bound, typename Limit, typename Visit>
  struct WalkByBound {
    using Priority = double;
    const Bound& bound;
    const Limit& limit;
    const Visit& visit;
    bool go_further() const { return true; }
    bool do_intersect(int, const Node& node) const { return bound(box_of_node(node)) <= limit(); }
    std::pair<bool, Priority> do_intersect_with_priority(int, const Node& node) const {
      const double least = bound(box_of_node(node));
      return {least <= limit(), -least};
    }
    void intersection(int, const FacePrimitive& face) const {
      if (bound(box_of(face.triangle().corners)) <= limit()) visit(face.triangle());
    }
  };

  CGAL::AABB_tree<Traits> tree_;
};

}  // namespace graspfit::geometry::internal
