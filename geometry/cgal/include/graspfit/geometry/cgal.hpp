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
#include <CGAL/boost/graph/iterator.h>
#include <CGAL/boost/graph/named_params_helper.h>
#include <CGAL/number_utils.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/convex_clip.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"

/// \file
/// Meshes, points, volumes and trees of CGAL as those of graspfit and back, for programs that have
/// both. A component of its own, `graspfit::geometry_cgal`: no other header of graspfit includes
/// CGAL. Coordinates are neither scaled nor moved: a TriangleMesh is in meters, in the frame in
/// which its points are given.

namespace graspfit::geometry::cgal {

/// The kernel of what is made here: exact predicates on double coordinates.
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// The same coordinates, nothing rounded.
inline Kernel::Point_3 point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

namespace internal {

// CGAL::to_double of a number of Epeck that was not computed exactly before may be off by 1e-5 of
// the number: it takes the middle of an interval that is not wider than that.
template <class Number>
double rounded(const Number& number) {
  if constexpr (requires { number.exact(); }) {
    const auto [low, high] = CGAL::to_interval(number);
    return low == high ? low : CGAL::to_double(number.exact());
  } else {
    return CGAL::to_double(number);
  }
}

[[noreturn]] inline void refuse(const char* who, const std::string& what) {
  throw base::InvalidInput(std::string("cgal::") + who + ": " + what);
}

// A vertex as it enters a mesh, whose indices are 32 bits wide.
inline Eigen::Vector3d checked_vertex(const char* who, const Eigen::Vector3d& vertex,
                                      std::size_t number) {
  if (!vertex.allFinite()) refuse(who, "vertex " + std::to_string(number) + " is not finite");
  if (number > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    refuse(who, "more than 2^31 vertices");
  }
  return vertex;
}

[[noreturn]] inline void refuse_polygon(const char* who, std::size_t face,
                                        std::size_t num_corners) {
  refuse(who, "face " + std::to_string(face) + " has " + std::to_string(num_corners) +
                  " corners, must have 3: triangulate the mesh first");
}

[[noreturn]] inline void refuse_index(const char* who, std::size_t face, std::int64_t index,
                                      std::size_t num_vertices) {
  refuse(who, "face " + std::to_string(face) + " has vertex " + std::to_string(index) + " of " +
                  std::to_string(num_vertices));
}

[[noreturn]] inline void refuse_face(const char* who, std::size_t number, const Face& face,
                                     const char* why) {
  refuse(who, "face " + std::to_string(number) + " (" + std::to_string(face[0]) + ", " +
                  std::to_string(face[1]) + ", " + std::to_string(face[2]) + ") " + why);
}

}  // namespace internal

/// The coordinates of a point or vector of any kernel. Nothing is rounded where these are doubles
/// (`Simple_cartesian<double>`, Epick). Coordinates of Epeck are computed exactly, then rounded,
/// each by less than one unit in its last place; those of other kernels by CGAL::to_double.
template <class PointOrVector>
Eigen::Vector3d vector(const PointOrVector& p) {
  return {internal::rounded(p.x()), internal::rounded(p.y()), internal::rounded(p.z())};
}

/// The vertices and faces of a FaceGraph (Surface_mesh, Polyhedron_3, ...) in its order, numbered
/// from 0 without gaps: vertices that no face uses stay, removed ones of a Surface_mesh are left
/// out. `np` may name a `vertex_point_map`; its points may be of any kernel, see `vector`.
/// @throws InvalidInput for the first vertex that is not finite, else the first face that is no
/// triangle.
template <class FaceGraph, class NamedParameters = CGAL::parameters::Default_named_parameters>
TriangleMesh triangle_mesh(const FaceGraph& graph,
                           const NamedParameters& np = CGAL::parameters::default_values()) {
  const auto points = CGAL::parameters::choose_parameter(
      CGAL::parameters::get_parameter(np, CGAL::internal_np::vertex_point),
      CGAL::get_const_property_map(CGAL::vertex_point, graph));
  using Vertex = typename boost::graph_traits<FaceGraph>::vertex_descriptor;
  TriangleMesh mesh;
  std::unordered_map<Vertex, std::int32_t> number_of;
  for (const Vertex v : vertices(graph)) {
    mesh.vertices.push_back(
        internal::checked_vertex("triangle_mesh", vector(get(points, v)), mesh.vertices.size()));
    number_of.emplace(v, base::as_index<std::int32_t>(mesh.vertices.size() - 1));
  }
  for (const auto f : faces(graph)) {
    Face face{};
    std::size_t size = 0;
    for (const Vertex v : CGAL::vertices_around_face(halfedge(f, graph), graph)) {
      if (size < 3) face[size] = number_of.at(v);
      ++size;
    }
    if (size != 3) internal::refuse_polygon("triangle_mesh", mesh.faces.size(), size);
    mesh.faces.push_back(face);
  }
  return mesh;
}

/// A soup: `points` of any kernel (see `vector`), `polygons` of three indices each. Nothing is
/// merged, oriented or left out.
/// @throws InvalidInput for the first point that is not finite, else the first polygon that is no
/// triangle or has an index that is no point's.
template <class Points, class Polygons>
TriangleMesh triangle_mesh_of_soup(const Points& points, const Polygons& polygons) {
  TriangleMesh mesh;
  for (const auto& p : points) {
    mesh.vertices.push_back(
        internal::checked_vertex("triangle_mesh_of_soup", vector(p), mesh.vertices.size()));
  }
  for (const auto& polygon : polygons) {
    const std::size_t size = std::size(polygon);
    if (size != 3) internal::refuse_polygon("triangle_mesh_of_soup", mesh.faces.size(), size);
    Face face{};
    std::size_t k = 0;
    for (const auto& index : polygon) {
      const auto number = static_cast<std::size_t>(index);
      if (number >= mesh.vertices.size()) {
        internal::refuse_index("triangle_mesh_of_soup", mesh.faces.size(),
                               static_cast<std::int64_t>(number), mesh.vertices.size());
      }
      face[k++] = static_cast<std::int32_t>(number);
    }
    mesh.faces.push_back(face);
  }
  return mesh;
}

/// The mesh as a FaceGraph whose points are made of three doubles: vertices and faces in their
/// order. Vertices that no face uses stay, and faces may have no area. Sheets may meet at a single
/// vertex if each has a border there, as CGAL allows.
/// @throws InvalidInput for the first vertex that is not finite, else the first face that has an
/// index that is no vertex's, or a vertex twice, or that cannot be joined to the faces before it:
/// it would make an edge or a vertex non-manifold, or runs through an edge in the direction of its
/// neighbor.
template <class FaceGraph = CGAL::Surface_mesh<Kernel::Point_3>>
FaceGraph face_graph(const TriangleMesh& mesh) {
  FaceGraph graph;
  const auto points = CGAL::get_property_map(CGAL::vertex_point, graph);
  using Points = typename boost::property_map<FaceGraph, CGAL::vertex_point_t>::type;
  using Point = typename boost::property_traits<Points>::value_type;
  using Vertex = typename boost::graph_traits<FaceGraph>::vertex_descriptor;
  std::vector<Vertex> vertices;
  vertices.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    const Eigen::Vector3d p = internal::checked_vertex("face_graph", vertex, vertices.size());
    vertices.push_back(add_vertex(graph));
    put(points, vertices.back(), Point(p.x(), p.y(), p.z()));
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Face& face = mesh.faces[f];
    for (const std::int32_t index : face) {
      if (index < 0 || index >= std::ssize(vertices)) {
        internal::refuse_index("face_graph", f, index, vertices.size());
      }
    }
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) {
      internal::refuse_face("face_graph", f, face, "has a vertex twice");
    }
    const std::array<Vertex, 3> corners = {vertices[face[0]], vertices[face[1]], vertices[face[2]]};
    const bool can_add =
        CGAL::Euler::can_add_face(corners, graph) &&
        CGAL::Euler::add_face(corners, graph) != boost::graph_traits<FaceGraph>::null_face();
    if (!can_add) {
      internal::refuse_face("face_graph", f, face,
                            "makes an edge or a vertex non-manifold, or is turned against a "
                            "neighbor; repair_mesh splits and turns such faces");
    }
  }
  return graph;
}

/// An axis-aligned box as a volume to clip by: closed. Coordinates are rounded as by `vector`.
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
/// CGAL's halfspace_intersection_3 has them. Coefficients are not normalized; they are rounded one
/// by one as coordinates are by `vector`, so only planes of Epeck move. A plane that is not finite
/// is refused by `clip`, not here.
template <class Planes>
ConvexVolume volume_of_planes(const Planes& planes) {
  ConvexVolume half_spaces;
  for (const auto& plane : planes) {
    half_spaces.push_back(
        {{internal::rounded(plane.a()), internal::rounded(plane.b()), internal::rounded(plane.c())},
         -internal::rounded(plane.d())});
  }
  return half_spaces;
}

/// CGAL's tree of a mesh's faces: `FaceTree(mesh).tree().closest_point(p)`. It holds copies of the
/// triangles, so that the mesh need not stay. Nearest points and intersections are constructed in
/// doubles, which means approximately; `MeshQuery` decides containment and ray hits exactly.
///
/// The tree of a mesh without faces is empty (`tree().empty()`), and an empty tree must not be
/// asked for a nearest point.
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

  /// @throws InvalidInput for a face whose indices are not all those of vertices, or with a vertex
  /// that is not finite.
  explicit FaceTree(const TriangleMesh& mesh) {
    triangles_.reserve(mesh.faces.size());
    for (std::int32_t f = 0; f < std::ssize(mesh.faces); ++f) {
      for (const auto index : mesh.faces[f]) {
        if (index < 0 || index >= std::ssize(mesh.vertices) || !mesh.vertices[index].allFinite()) {
          throw base::InvalidInput("FaceTree: face " + std::to_string(f) + " has vertex " +
                                   std::to_string(index) + ", which is none or is not finite");
        }
      }
      const auto [a, b, c] = corners(mesh, f);
      triangles_.emplace_back(point(a), point(b), point(c));
    }
    tree_->insert(triangles_.cbegin(), triangles_.cend());
    tree_->build();
  }
  FaceTree(const FaceTree&) = delete;
  FaceTree& operator=(const FaceTree&) = delete;
  FaceTree(FaceTree&&) = default;  // the triangles stay where they are in memory
  FaceTree& operator=(FaceTree&&) = default;

  /// The tree, for all of CGAL's queries. It stays where it is when this object is moved.
  const Tree& tree() const { return *tree_; }

  /// The index of a face in the mesh, from the id of a primitive of the tree.
  std::size_t face(Tree::Primitive_id id) const {
    return static_cast<std::size_t>(id - triangles_.cbegin());
  }

 private:
  Triangles triangles_;
  // Not moved itself: what a tree of CGAL's that was asked for a nearest point leaves behind fails
  // an assertion in its destructor.
  std::unique_ptr<Tree> tree_ = std::make_unique<Tree>();
};

}  // namespace graspfit::geometry::cgal
