#include "queries_by_cgal.hpp"

#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Rigid_triangle_mesh_collision_detection.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/cgal.hpp"

namespace graspfit::testing {
namespace {

namespace adapter = geometry::cgal;
namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = adapter::Kernel;
using Graph = CGAL::Surface_mesh<Kernel::Point_3>;
using Tree = adapter::FaceTree::Tree;

Kernel::Ray_3 ray(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  return {adapter::point(origin), Kernel::Vector_3(direction.x(), direction.y(), direction.z())};
}

}  // namespace

struct QueriesByCgal::Impl {
  Graph graph;
  CGAL::Side_of_triangle_mesh<Graph, Kernel> side_of;
  adapter::FaceTree::Triangles triangles;
  std::optional<Tree> tree;

  explicit Impl(const geometry::TriangleMesh& mesh)
      : graph(adapter::face_graph(mesh)), side_of(graph) {}
};

QueriesByCgal::QueriesByCgal(const geometry::TriangleMesh& mesh)
    : impl_(std::make_unique<Impl>(mesh)) {}

QueriesByCgal::~QueriesByCgal() = default;

void QueriesByCgal::build_tree(const geometry::TriangleMesh& mesh, bool for_distances) {
  impl_->tree.reset();
  adapter::FaceTree::Triangles& triangles = impl_->triangles;
  triangles.clear();
  triangles.reserve(mesh.faces.size());
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const auto [a, b, c] = geometry::corners(mesh, face);
    triangles.emplace_back(adapter::point(a), adapter::point(b), adapter::point(c));
  }
  impl_->tree.emplace(triangles.cbegin(), triangles.cend());
  impl_->tree->build();
  if (for_distances) impl_->tree->accelerate_distance_queries();
}

double QueriesByCgal::distance(const Eigen::Vector3d& point) const {
  const Kernel::Point_3 query = adapter::point(point);
  const auto [nearest, face] = impl_->tree->closest_point_and_primitive(query);
  return std::sqrt(CGAL::squared_distance(query, nearest));
}

bool QueriesByCgal::is_inside(const Eigen::Vector3d& point) const {
  return impl_->side_of(adapter::point(point)) == CGAL::ON_BOUNDED_SIDE;
}

bool QueriesByCgal::does_hit(const Eigen::Vector3d& origin,
                             const Eigen::Vector3d& direction) const {
  return static_cast<bool>(impl_->tree->first_intersection(ray(origin, direction)));
}

std::size_t QueriesByCgal::num_hits(const Eigen::Vector3d& origin,
                                    const Eigen::Vector3d& direction) const {
  std::vector<Tree::Intersection_and_primitive_id<Kernel::Ray_3>::Type> hits;
  impl_->tree->all_intersections(ray(origin, direction), std::back_inserter(hits));
  return hits.size();
}

std::size_t QueriesByCgal::num_faces_in(const Eigen::AlignedBox3d& box) const {
  std::vector<Tree::Primitive_id> faces;
  impl_->tree->all_intersected_primitives(
      Kernel::Iso_cuboid_3(adapter::point(box.min()), adapter::point(box.max())),
      std::back_inserter(faces));
  return faces.size();
}

std::size_t QueriesByCgal::num_self_intersections() const {
  std::vector<std::pair<Graph::Face_index, Graph::Face_index>> pairs;
  pmp::self_intersections(impl_->graph, std::back_inserter(pairs));
  return pairs.size();
}

struct CollisionByCgal::Impl {
  Graph a;
  Graph b;
  CGAL::Rigid_triangle_mesh_collision_detection<Graph> detection;
  std::size_t id_a;
  std::size_t id_b;

  Impl(const geometry::TriangleMesh& mesh_a, const geometry::TriangleMesh& mesh_b)
      : a(adapter::face_graph(mesh_a)),
        b(adapter::face_graph(mesh_b)),
        id_a(detection.add_mesh(a)),
        id_b(detection.add_mesh(b)) {}
};

CollisionByCgal::CollisionByCgal(const geometry::TriangleMesh& a, const geometry::TriangleMesh& b)
    : impl_(std::make_unique<Impl>(a, b)) {}

CollisionByCgal::~CollisionByCgal() = default;

bool CollisionByCgal::do_intersect(const geometry::RigidTransform& X_AB) {
  const Eigen::Matrix3d R = X_AB.linear();
  const Eigen::Vector3d t = X_AB.translation();
  impl_->detection.set_transformation(
      impl_->id_b, CGAL::Aff_transformation_3<Kernel>(R(0, 0), R(0, 1), R(0, 2), t[0],  //
                                                      R(1, 0), R(1, 1), R(1, 2), t[1],  //
                                                      R(2, 0), R(2, 1), R(2, 2), t[2]));
  return !impl_->detection.get_all_intersections_and_inclusions(impl_->id_a).empty();
}

struct UnionByCgal::Impl {
  std::vector<Graph> parts;
  Graph all;
};

UnionByCgal::UnionByCgal(std::span<const geometry::TriangleMesh> parts)
    : impl_(std::make_unique<Impl>()) {
  if (parts.empty()) throw base::InvalidInput("a union needs parts");
  for (const geometry::TriangleMesh& part : parts) {
    impl_->parts.push_back(adapter::face_graph(part));
  }
}

UnionByCgal::~UnionByCgal() = default;

std::size_t UnionByCgal::unite() {
  impl_->all = impl_->parts.front();
  for (std::size_t i = 1; i < impl_->parts.size(); ++i) {
    Graph part = impl_->parts[i];
    Graph both;
    if (!pmp::corefine_and_compute_union(impl_->all, part, both)) {
      throw base::DegenerateGeometry("CGAL finds no manifold union");
    }
    impl_->all = std::move(both);
  }
  return impl_->all.number_of_faces();
}

double UnionByCgal::volume() const { return CGAL::to_double(pmp::volume(impl_->all)); }

std::size_t num_hull_facets_by_cgal(std::span<const Eigen::Vector3d> points) {
  std::vector<Kernel::Point_3> given;
  given.reserve(points.size());
  for (const Eigen::Vector3d& point : points) given.push_back(adapter::point(point));
  Graph hull;
  CGAL::convex_hull_3(given.begin(), given.end(), hull);
  return hull.number_of_faces();
}

}  // namespace graspfit::testing
