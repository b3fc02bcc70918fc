#pragma once

#include <CGAL/version.h>
#if CGAL_VERSION_NR >= 1060000000
#include <CGAL/AABB_traits_3.h>
#include <CGAL/AABB_triangle_primitive_3.h>
#else
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_triangle_primitive.h>
#endif
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Iso_cuboid_3.h>
#include <CGAL/Named_function_parameters.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <CGAL/boost/graph/named_params_helper.h>
#include <CGAL/number_utils.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/convex_clip.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"

/// \file
/// Meshes, points, volumes and trees of CGAL as those of graspfit and back, for programs that have
/// both. A component of its own, `graspfit::geometry_cgal`: no other header of graspfit includes
/// CGAL.

namespace graspfit::geometry::cgal {

/// The kernel of what is made here: exact predicates on double coordinates.
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// The same coordinates, nothing rounded.
inline Kernel::Point_3 point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

/// The coordinates of a point or vector of any kernel. Nothing is rounded where these are doubles
/// (`Simple_cartesian<double>`, Epick); coordinates of Epeck are rounded, by CGAL::to_double.
template <class PointOrVector>
Eigen::Vector3d vector(const PointOrVector& p) {
  return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
}

namespace internal {

inline Eigen::Vector3d finite_vertex(const Eigen::Vector3d& vertex, std::size_t number) {
  if (vertex.allFinite()) return vertex;
  throw base::InvalidInput("vertex " + std::to_string(number) + " is not finite");
}

[[noreturn]] inline void refuse_polygon(std::size_t face, std::size_t num_corners) {
  throw base::InvalidInput("face " + std::to_string(face) + " has " + std::to_string(num_corners) +
                           " corners, must have 3: triangulate the mesh first");
}

}  // namespace internal

/// The vertices and faces of a FaceGraph (Surface_mesh, Polyhedron_3, ...) in its order, numbered
/// from 0 without gaps. `np` may name a `vertex_point_map`; its points may be of any kernel.
/// @throws InvalidInput for the first face that is no triangle or vertex that is not finite.
template <class FaceGraph, class NamedParameters = CGAL::parameters::Default_named_parameters>
TriangleMesh triangle_mesh(const FaceGraph& graph,
                           const NamedParameters& np = CGAL::parameters::default_values()) {
  const auto points = CGAL::parameters::choose_parameter(
      CGAL::parameters::get_parameter(np, CGAL::internal_np::vertex_point),
      get_const_property_map(CGAL::vertex_point, graph));
  using Vertex = typename boost::graph_traits<FaceGraph>::vertex_descriptor;
  TriangleMesh mesh;
  std::unordered_map<Vertex, std::int32_t> number_of;
  for (const Vertex v : vertices(graph)) {
    number_of.emplace(v, static_cast<std::int32_t>(mesh.vertices.size()));
    mesh.vertices.push_back(internal::finite_vertex(vector(get(points, v)), mesh.vertices.size()));
  }
  for (const auto f : faces(graph)) {
    Face face{};
    std::size_t size = 0;
    for (const Vertex v : CGAL::vertices_around_face(halfedge(f, graph), graph)) {
      if (size < 3) face[size] = number_of.at(v);
      ++size;
    }
    if (size != 3) internal::refuse_polygon(mesh.faces.size(), size);
    mesh.faces.push_back(face);
  }
  return mesh;
}

/// A soup: `points` of any kernel, `polygons` of three indices each.
/// @throws InvalidInput for the first polygon that is no triangle, index that is no point's, or
/// point that is not finite.
template <class Points, class Polygons>
TriangleMesh triangle_mesh_of_soup(const Points& points, const Polygons& polygons) {
  TriangleMesh mesh;
  for (const auto& p : points) {
    mesh.vertices.push_back(internal::finite_vertex(vector(p), mesh.vertices.size()));
  }
  for (const auto& polygon : polygons) {
    const std::size_t size = std::size(polygon);
    if (size != 3) internal::refuse_polygon(mesh.faces.size(), size);
    Face face{};
    std::size_t k = 0;
    for (const auto& index : polygon) {
      const auto number = static_cast<std::size_t>(index);
      if (number >= mesh.vertices.size()) {
        throw base::InvalidInput("face " + std::to_string(mesh.faces.size()) + " has vertex " +
                                 std::to_string(number) + " of " +
                                 std::to_string(mesh.vertices.size()));
      }
      face[k++] = static_cast<std::int32_t>(number);
    }
    mesh.faces.push_back(face);
  }
  return mesh;
}

/// The mesh as a FaceGraph whose points are made of three doubles: vertices and faces in their
/// order. Vertices that no face uses stay.
/// @throws InvalidInput for the first face that would make an edge or a vertex non-manifold, with
/// the faces before it.
template <class FaceGraph = CGAL::Surface_mesh<Kernel::Point_3>>
FaceGraph face_graph(const TriangleMesh& mesh) {
  FaceGraph graph;
  const auto points = get_property_map(CGAL::vertex_point, graph);
  using Points = typename boost::property_map<FaceGraph, CGAL::vertex_point_t>::type;
  using Point = typename boost::property_traits<Points>::value_type;
  using Vertex = typename boost::graph_traits<FaceGraph>::vertex_descriptor;
  std::vector<Vertex> vertices;
  vertices.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& p : mesh.vertices) {
    vertices.push_back(add_vertex(graph));
    put(points, vertices.back(), Point(p.x(), p.y(), p.z()));
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Face& face = mesh.faces[f];
    const std::array<Vertex, 3> corners = {vertices.at(face[0]), vertices.at(face[1]),
                                           vertices.at(face[2])};
    const bool can_add =
        face[0] != face[1] && face[1] != face[2] && face[2] != face[0] &&
        CGAL::Euler::can_add_face(corners, graph) &&
        CGAL::Euler::add_face(corners, graph) != boost::graph_traits<FaceGraph>::null_face();
    if (!can_add) {
      throw base::InvalidInput(
          "face " + std::to_string(f) + " (" + std::to_string(face[0]) + ", " +
          std::to_string(face[1]) + ", " + std::to_string(face[2]) +
          ") makes an edge or a vertex non-manifold; repair_mesh splits such meshes");
    }
  }
  return graph;
}

/// An axis-aligned box as a volume to clip by: closed. Coordinates of Epeck are rounded.
template <class K>
ConvexVolume volume(const CGAL::Iso_cuboid_3<K>& box) {
  const Eigen::Vector3d lower = vector((box.min)());
  const Eigen::Vector3d upper = vector((box.max)());
  ConvexVolume half_spaces;
  for (int axis = 0; axis < 3; ++axis) {
    half_spaces.push_back({Eigen::Vector3d::Unit(axis), upper[axis]});
    half_spaces.push_back({-Eigen::Vector3d::Unit(axis), -lower[axis]});
  }
  return half_spaces;
}

/// The intersection of the closed negative sides a x + b y + c z + d ≤ 0 of a range of Plane_3, as
/// CGAL's halfspace_intersection_3 has them. Coefficients of Epeck are rounded.
template <class Planes>
ConvexVolume volume_of_planes(const Planes& planes) {
  ConvexVolume half_spaces;
  for (const auto& plane : planes) {
    half_spaces.push_back(
        {{CGAL::to_double(plane.a()), CGAL::to_double(plane.b()), CGAL::to_double(plane.c())},
         -CGAL::to_double(plane.d())});
  }
  return half_spaces;
}

/// CGAL's tree of a mesh's faces: `FaceTree(mesh).tree().closest_point(p)`. It holds copies of the
/// triangles, so that the mesh need not stay.
class FaceTree {
 public:
  using Triangles = std::vector<Kernel::Triangle_3>;
#if CGAL_VERSION_NR >= 1060000000
  using Traits =
      CGAL::AABB_traits_3<Kernel,
                          CGAL::AABB_triangle_primitive_3<Kernel, Triangles::const_iterator>>;
#else
  using Traits =
      CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>;
#endif
  using Tree = CGAL::AABB_tree<Traits>;

  explicit FaceTree(const TriangleMesh& mesh) {
    triangles_.reserve(mesh.faces.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const auto [a, b, c] = corners(mesh, f);
      triangles_.emplace_back(point(a), point(b), point(c));
    }
    tree_.insert(triangles_.cbegin(), triangles_.cend());
    tree_.build();
  }
  FaceTree(const FaceTree&) = delete;
  FaceTree& operator=(const FaceTree&) = delete;
  FaceTree(FaceTree&&) = default;  // the triangles stay where they are in memory
  FaceTree& operator=(FaceTree&&) = default;

  const Tree& tree() const { return tree_; }

  /// The index of a face in the mesh, from the id of a primitive of the tree.
  std::size_t face(Tree::Primitive_id id) const {
    return static_cast<std::size_t>(id - triangles_.cbegin());
  }

 private:
  Triangles triangles_;
  Tree tree_;
};

}  // namespace graspfit::geometry::cgal
