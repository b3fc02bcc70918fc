#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "graspfit/base/random.hpp"
#include "graspfit/geometry/cgal.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

namespace graspfit::test_cgal_adapter {

using base::InvalidInput;
using Eigen::Vector3d;
using geometry::Face;
using geometry::TriangleMesh;
using testing::Contains;
namespace adapter = geometry::cgal;

using Epick = adapter::Kernel;
using Epeck = CGAL::Exact_predicates_exact_constructions_kernel;
using Plain = CGAL::Simple_cartesian<double>;
template <class K>
using SurfaceMesh = CGAL::Surface_mesh<typename K::Point_3>;

namespace {

/// Returns the faces, each from its lowest corner on.
std::vector<Face> from_lowest(std::vector<Face> faces) {
  for (Face& face : faces) {
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  }
  return faces;
}

template <class FaceGraph>
void check_round_trip() {
  const TriangleMesh torus = geometry::torus(0.05, 0.02, 24, 12);
  const TriangleMesh back = adapter::triangle_mesh(adapter::face_graph<FaceGraph>(torus));
  CHECK(back.vertices == torus.vertices);
  CHECK(from_lowest(back.faces) == from_lowest(torus.faces));
}

template <class Function>
std::string refusal(const Function& function) {
  try {
    function();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("A mesh becomes any FaceGraph of CGAL and comes back the same", "[geometry][cgal]") {
  check_round_trip<SurfaceMesh<Epick>>();
  check_round_trip<SurfaceMesh<Epeck>>();
  check_round_trip<SurfaceMesh<Plain>>();
  check_round_trip<CGAL::Polyhedron_3<Epick>>();
  check_round_trip<CGAL::Polyhedron_3<Plain>>();
}

TEST_CASE("A mesh without faces or vertices becomes one of CGAL and comes back",
          "[geometry][cgal]") {
  CHECK(adapter::triangle_mesh(adapter::face_graph(TriangleMesh{})) == TriangleMesh{});
  const TriangleMesh unused{{{0, 0, 0}, {1, 2, 3}}, {}};
  CHECK(adapter::triangle_mesh(adapter::face_graph(unused)) == unused);
  CHECK(adapter::FaceTree(unused).tree().empty());
}

TEST_CASE("Removed vertices and faces of a Surface_mesh leave no gaps", "[geometry][cgal]") {
  const TriangleMesh box = geometry::box({1.0, 2.0, 3.0});
  auto graph = adapter::face_graph(box);
  using Graph = decltype(graph);
  const Graph::Face_index first = *graph.faces_begin();
  CGAL::Euler::remove_face(graph.halfedge(first), graph);
  // Added before the other is removed, whose place it would have otherwise.
  const Graph::Vertex_index removed = graph.add_vertex(Epick::Point_3(9, 9, 9));
  graph.add_vertex(Epick::Point_3(7, 7, 7));
  graph.remove_vertex(removed);
  REQUIRE(graph.number_of_removed_vertices() == 1);
  REQUIRE(graph.number_of_removed_faces() == 1);
  const TriangleMesh mesh = adapter::triangle_mesh(graph);
  CHECK(mesh.vertices.size() == 9);
  CHECK(mesh.vertices.back() == Vector3d(7, 7, 7));
  const std::vector<Face> rest(box.faces.begin() + 1, box.faces.end());
  CHECK(from_lowest(mesh.faces) == from_lowest(rest));
}

TEST_CASE("Points are those of the map that is named, of another kernel too", "[geometry][cgal]") {
  auto graph = adapter::face_graph(geometry::box({1.0, 2.0, 3.0}));
  using Vertex = decltype(graph)::Vertex_index;
  const auto doubled = graph.add_property_map<Vertex, Plain::Point_3>("v:doubled").first;
  for (const Vertex v : graph.vertices()) {
    const Epick::Point_3& p = graph.point(v);
    doubled[v] = Plain::Point_3(2 * p.x(), 2 * p.y(), 2 * p.z());
  }
  const TriangleMesh mesh =
      adapter::triangle_mesh(graph, CGAL::parameters::vertex_point_map(doubled));
  CHECK(mesh.vertices == geometry::box({2.0, 4.0, 6.0}).vertices);
}

TEST_CASE("Numbers of Epeck are rounded to doubles, others kept", "[geometry][cgal]") {
  CHECK(adapter::vector(Plain::Point_3(0.1, -0.2, 0.3)) == Vector3d(0.1, -0.2, 0.3));
  CHECK(adapter::vector(adapter::point({0.1, -0.2, 0.3})) == Vector3d(0.1, -0.2, 0.3));
  const Epeck::FT third = Epeck::FT(1) / 3;
  // The same number, of which CGAL has an interval 2^-19 wide until it is computed exactly; in the
  // middle of that, which is 3e-7 from a third, it sees a double that is good enough.
  const auto vague_third = [&] {
    const Epeck::FT large = 1e10;
    return Epeck::FT((large + third) - large);
  };
  const double ulp = 0x1p-54;  // of 1/3
  const Vector3d rounded = adapter::vector(Epeck::Point_3(third, 2, vague_third()));
  CHECK(std::abs(rounded.x() - 1.0 / 3.0) <= ulp);
  CHECK(rounded.y() == 2.0);
  CHECK(std::abs(rounded.z() - 1.0 / 3.0) <= ulp);
  const std::vector<Epeck::Plane_3> planes = {Epeck::Plane_3(1, 0, 0, -vague_third())};
  const geometry::ConvexVolume volume = adapter::volume_of_planes(planes);
  CHECK(volume.front().normal == Vector3d(1, 0, 0));
  CHECK(std::abs(volume.front().offset - 1.0 / 3.0) <= ulp);
}

TEST_CASE("What is no triangle mesh is refused by its first fault", "[geometry][cgal]") {
  SurfaceMesh<Epick> quad;
  std::vector<SurfaceMesh<Epick>::Vertex_index> corners;
  for (const auto& [x, y] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
    corners.push_back(quad.add_vertex(Epick::Point_3(x, y, 0)));
  }
  quad.add_face(corners[0], corners[1], corners[2], corners[3]);
  CHECK(refusal([&] { adapter::triangle_mesh(quad); }) ==
        "cgal::triangle_mesh: face 0 has 4 corners, must have 3: triangulate the mesh first");
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  quad.add_vertex(Epick::Point_3(0, kNan, 0));
  CHECK(refusal([&] { adapter::triangle_mesh(quad); }) ==
        "cgal::triangle_mesh: vertex 4 is not finite");

  TriangleMesh fan{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}}, {}};
  fan.faces = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};  // These are three faces at an edge.
  CHECK_THAT(refusal([&] { adapter::face_graph(fan); }),
             Contains("face 2 (0, 1, 4) makes an edge or a vertex non-manifold"));
  fan.faces = {{0, 1, 2}, {0, 1, 3}};  // both run from 0 to 1
  CHECK_THAT(refusal([&] { adapter::face_graph(fan); }), Contains("face 1 (0, 1, 3)"));
  fan.faces = {{0, 1, 2}, {3, 3, 4}};
  CHECK(refusal([&] { adapter::face_graph(fan); }) ==
        "cgal::face_graph: face 1 (3, 3, 4) has a vertex twice");
  fan.faces = {{0, 1, 5}};
  CHECK(refusal([&] { adapter::face_graph(fan); }) == "cgal::face_graph: face 0 has vertex 5 of 5");
  fan.faces = {{0, -1, 2}};
  CHECK(refusal([&] { adapter::face_graph(fan); }) ==
        "cgal::face_graph: face 0 has vertex -1 of 5");
  fan.vertices[3].z() = kNan;
  CHECK(refusal([&] { adapter::face_graph(fan); }) == "cgal::face_graph: vertex 3 is not finite");
}

TEST_CASE("Sheets may meet at a vertex where both have borders, closed surfaces may not",
          "[geometry][cgal]") {
  TriangleMesh mesh{
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {}};
  mesh.faces = {{0, 1, 2}, {0, 4, 5}};
  const TriangleMesh back = adapter::triangle_mesh(adapter::face_graph(mesh));
  CHECK(from_lowest(back.faces) == mesh.faces);
  // A tetrahedron of the first four vertices, and one of the first and the last three.
  mesh.faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3},
                {0, 4, 5}, {0, 6, 4}, {0, 5, 6}, {4, 6, 5}};
  CHECK_THAT(refusal([&] { adapter::face_graph(mesh); }), Contains("face 4 (0, 4, 5)"));
}

TEST_CASE("A soup of any index type becomes a mesh, or its first fault is named",
          "[geometry][cgal]") {
  const std::vector<Plain::Point_3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<std::vector<std::size_t>> polygons = {{0, 1, 2}};
  const TriangleMesh mesh = adapter::triangle_mesh_of_soup(points, polygons);
  CHECK(mesh.vertices.size() == 3);
  CHECK(mesh.faces == std::vector<Face>{{0, 1, 2}});
  CHECK(adapter::triangle_mesh_of_soup(points, std::vector<std::array<int, 3>>{{2, 0, 1}}).faces ==
        std::vector<Face>{{2, 0, 1}});
  CHECK(refusal([&] {
          adapter::triangle_mesh_of_soup(points, std::vector<std::array<int, 3>>{{2, 0, 3}});
        }) == "cgal::triangle_mesh_of_soup: face 0 has vertex 3 of 3");
  CHECK(refusal([&] {
          adapter::triangle_mesh_of_soup(points, std::vector<std::array<int, 3>>{{2, 0, -1}});
        }) == "cgal::triangle_mesh_of_soup: face 0 has vertex -1 of 3");
  CHECK_THAT(
      refusal([&] {
        adapter::triangle_mesh_of_soup(points, std::vector<std::vector<int>>{{0, 1, 2}, {0, 1}});
      }),
      Contains("face 1 has 2 corners"));
}

TEST_CASE("Boxes and planes of CGAL clip as the half-spaces that they are", "[geometry][cgal]") {
  const TriangleMesh mesh = geometry::box({2.0, 2.0, 2.0});
  std::vector<std::int32_t> all;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) all.push_back(static_cast<std::int32_t>(f));
  const auto area_in = [&](const geometry::ConvexVolume& volume) {
    double area = 0.0;
    for (const geometry::ClippedPiece& piece : geometry::clip(mesh, all, volume)) {
      area += piece.area;
    }
    return area;
  };
  // The box holds a corner of the cube with three squares of 0.5 edge length.
  const auto box =
      adapter::volume(Epeck::Iso_cuboid_3(Epeck::Point_3(0.5, 0.5, 0.5), Epeck::Point_3(2, 2, 2)));
  CHECK(area_in(box) == Approx(0.75).epsilon(1e-12));
  // The planes of x + y <= 1 and z >= 1 are given with their negative sides. They leave the upper
  // square of area 4 but for the corner triangle of 1/2 where x + y > 1.
  const std::vector<Epick::Plane_3> planes = {Epick::Plane_3(1, 1, 0, -1),
                                              Epick::Plane_3(0, 0, -1, 1)};
  CHECK(area_in(adapter::volume_of_planes(planes)) == Approx(3.5).epsilon(1e-12));
}

TEST_CASE("CGAL's tree and MeshQuery find the same nearest points", "[geometry][cgal]") {
  const TriangleMesh mesh = geometry::torus(0.05, 0.02, 48, 24);
  const geometry::MeshQuery query(mesh);
  adapter::FaceTree first(mesh);
  first.tree().closest_point(adapter::point({0, 0, 0}));
  // Its triangles stay where they are, and so does the tree that CGAL made for the question.
  const adapter::FaceTree tree = std::move(first);
  base::Random random(7);
  for (int i = 0; i < 200; ++i) {
    const Vector3d p(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1),
                     random.uniform(-0.1, 0.1));
    const auto [nearest, id] = tree.tree().closest_point_and_primitive(adapter::point(p));
    const double distance = (adapter::vector(nearest) - p).norm();
    const double ours = std::sqrt(query.closest_point(p).squared_distance);
    CHECK(distance == Approx(ours).margin(1e-12));
    const auto corners = geometry::corners(mesh, tree.face(id));
    CHECK(Epick::Triangle_3(adapter::point(corners[0]), adapter::point(corners[1]),
                            adapter::point(corners[2])) == *id);
  }
  TriangleMesh bad = mesh;
  bad.faces[3][1] = static_cast<std::int32_t>(mesh.vertices.size());
  CHECK_THROWS_AS(adapter::FaceTree(bad), base::InvalidInput);
  bad = mesh;
  bad.vertices[5].y() = std::nan("");
  CHECK_THROWS_AS(adapter::FaceTree(bad), base::InvalidInput);
}

}  // namespace graspfit::test_cgal_adapter
