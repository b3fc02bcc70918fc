#include "hull/exact_hull.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_2.h>
#include <CGAL/convex_hull_3.h>

#include <algorithm>
#include <cassert>
#include <functional>
#include <iterator>
#include <numeric>
#include <tuple>

#include "exact/predicates.hpp"
#include "graspfit/base/disjoint_sets.hpp"

namespace graspfit::geometry::internal {
namespace {

using Eigen::Vector3d;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Indices = std::vector<std::size_t>;

}  // namespace

std::vector<std::size_t> distinct_points(std::span<const Vector3d> points) {
  const auto coordinates = [&](std::size_t i) {
    return std::tie(points[i].x(), points[i].y(), points[i].z());
  };
  Indices order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return coordinates(a) < coordinates(b); });
  order.erase(
      std::unique(order.begin(), order.end(),
                  [&](std::size_t a, std::size_t b) { return coordinates(a) == coordinates(b); }),
      order.end());
  return order;
}

namespace {

template <typename Ring, typename Less>
void start_at_least(Ring& ring, const Less& less) {
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end(), less), ring.end());
}

/// CGAL's hull of points that span space, with what makes it canonical.
class SolidHull {
 public:
  SolidHull(std::span<const Vector3d> points, const Indices& sorted)
      : points_(points), sorted_(sorted) {
    std::vector<Kernel::Point_3> given;
    given.reserve(sorted.size());
    for (const std::size_t i : sorted) {
      given.emplace_back(points[i].x(), points[i].y(), points[i].z());
    }
    CGAL::convex_hull_3(given.begin(), given.end(), mesh_);
    find_facets();
  }

  ExactHull canonical() const {
    ExactHull hull;
    hull.rank = 3;
    std::vector<char> is_corner(mesh_.number_of_vertices(), 0);
    for (const Mesh::Vertex_index vertex : mesh_.vertices()) {
      if (!is_extreme(vertex)) continue;
      is_corner[vertex] = 1;
      hull.corners.push_back(index_of(vertex));
    }
    std::sort(hull.corners.begin(), hull.corners.end());
    const auto by_coordinates = [&](std::size_t a, std::size_t b) {
      return std::tie(points_[a].x(), points_[a].y(), points_[a].z()) <
             std::tie(points_[b].x(), points_[b].y(), points_[b].z());
    };
    std::vector<char> is_done(mesh_.number_of_faces(), 0);
    for (const Mesh::Halfedge_index start : mesh_.halfedges()) {
      if (!is_rim(start) || is_done[facet_of(start)] != 0) continue;
      is_done[facet_of(start)] = 1;
      Indices ring;
      Mesh::Halfedge_index side = start;
      do {
        if (is_corner[mesh_.target(side)] != 0) ring.push_back(index_of(mesh_.target(side)));
        side = next_on_rim(side);
      } while (side != start);
      start_at_least(ring, by_coordinates);
      for (std::size_t i = 2; i < ring.size(); ++i) {
        std::array<std::size_t, 3> triangle = {ring[0], ring[i - 1], ring[i]};
        start_at_least(triangle, std::less<>());
        hull.triangles.push_back(triangle);
      }
    }
    std::sort(hull.triangles.begin(), hull.triangles.end());
    return hull;
  }

 private:
  /// A facet is the set of coplanar triangles that hang together.
  void find_facets() {
    base::DisjointSets sets(mesh_.number_of_faces());
    for (const Mesh::Edge_index edge : mesh_.edges()) {
      const Mesh::Halfedge_index side = mesh_.halfedge(edge);
      const Mesh::Halfedge_index other = mesh_.opposite(side);
      const int bend =
          orientation(at(mesh_.source(side)), at(mesh_.target(side)),
                      at(mesh_.target(mesh_.next(side))), at(mesh_.target(mesh_.next(other))));
      assert(bend <= 0);  // The hull is convex.
      if (bend == 0) {
        sets.unite(static_cast<std::int32_t>(mesh_.face(side).idx()),
                   static_cast<std::int32_t>(mesh_.face(other).idx()));
      }
    }
    facet_of_face_.resize(mesh_.number_of_faces());
    for (std::int32_t face = 0; face < std::ssize(facet_of_face_); ++face) {
      facet_of_face_[face] = sets.root(face);
    }
  }

  std::int32_t facet_of(Mesh::Halfedge_index side) const {
    return facet_of_face_[mesh_.face(side).idx()];
  }

  bool is_rim(Mesh::Halfedge_index side) const {
    return facet_of(side) != facet_of(mesh_.opposite(side));
  }

  Mesh::Halfedge_index next_on_rim(Mesh::Halfedge_index side) const {
    Mesh::Halfedge_index next = mesh_.next(side);
    while (!is_rim(next)) next = mesh_.next(mesh_.opposite(next));
    return next;
  }

  /// Within a facet a vertex touches one facet, within an edge two.
  bool is_extreme(Mesh::Vertex_index vertex) const {
    int num_rims = 0;
    for (const Mesh::Halfedge_index side :
         CGAL::halfedges_around_target(mesh_.halfedge(vertex), mesh_)) {
      num_rims += is_rim(side) ? 1 : 0;
    }
    return num_rims >= 3;
  }

  const Vector3d& at(Mesh::Vertex_index vertex) const { return points_[index_of(vertex)]; }

  std::size_t index_of(Mesh::Vertex_index vertex) const {
    const Kernel::Point_3& p = mesh_.point(vertex);
    const auto found =
        std::lower_bound(sorted_.begin(), sorted_.end(), p, [&](std::size_t i, const auto& of) {
          return std::make_tuple(points_[i].x(), points_[i].y(), points_[i].z()) <
                 std::make_tuple(of.x(), of.y(), of.z());
        });
    return *found;
  }

  std::span<const Vector3d> points_;
  const Indices& sorted_;
  Mesh mesh_;
  std::vector<std::int32_t> facet_of_face_;
};

}  // namespace

std::vector<std::size_t> hull_in_plane(std::span<const Vector3d> points,
                                       std::span<const std::size_t> chosen, int u, int v) {
  const auto less = [&](std::size_t a, std::size_t b) {
    return std::tie(points[a][u], points[a][v], a) < std::tie(points[b][u], points[b][v], b);
  };
  const auto are_equal = [&](std::size_t a, std::size_t b) {
    return points[a][u] == points[b][u] && points[a][v] == points[b][v];
  };
  Indices order(chosen.begin(), chosen.end());
  std::sort(order.begin(), order.end(), less);
  order.erase(std::unique(order.begin(), order.end(), are_equal), order.end());
  std::vector<Kernel::Point_2> given;
  for (const std::size_t i : order) given.emplace_back(points[i][u], points[i][v]);
  std::vector<Kernel::Point_2> corners;
  CGAL::convex_hull_2(given.begin(), given.end(), std::back_inserter(corners));
  Indices ring;
  for (const Kernel::Point_2& corner : corners) {
    const auto found = std::lower_bound(given.begin(), given.end(), corner);
    ring.push_back(order[found - given.begin()]);
  }
  start_at_least(ring, less);
  return ring;
}

ExactHull exact_hull(std::span<const Vector3d> points) {
  const Indices sorted = distinct_points(points);
  ExactHull hull;
  if (sorted.empty()) return hull;
  const Vector3d& first = points[sorted.front()];
  const Vector3d& last = points[sorted.back()];
  // The ends of a lexicographic order are extreme points.
  if (sorted.size() == 1) {
    hull.rank = 0;
    hull.corners = sorted;
    return hull;
  }
  const auto off_line = std::find_if(sorted.begin(), sorted.end(), [&](std::size_t i) {
    return !are_collinear(first, last, points[i]);
  });
  if (off_line == sorted.end()) {
    hull.rank = 1;
    hull.corners = {sorted.front(), sorted.back()};
    std::sort(hull.corners.begin(), hull.corners.end());
    return hull;
  }
  const Vector3d& third = points[*off_line];
  if (std::any_of(sorted.begin(), sorted.end(),
                  [&](std::size_t i) { return orientation(first, last, third, points[i]) != 0; })) {
    return SolidHull(points, sorted).canonical();
  }
  hull.rank = 2;
  for (const auto& [u, v] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
    if (orientation_2d(first, last, third, u, v) == 0) continue;
    hull.corners = hull_in_plane(points, sorted, u, v);
    start_at_least(hull.corners, std::less<>());
    break;
  }
  return hull;
}

}  // namespace graspfit::geometry::internal
