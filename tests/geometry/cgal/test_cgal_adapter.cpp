#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <limits>
#include <utility>

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

/// The faces, each from its lowest corner on.
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

TEST_CASE("Removed vertices and faces of a Surface_mesh leave no gaps", "[geometry][cgal]") {
  auto graph = adapter::face_graph(geometry::box({1.0, 2.0, 3.0}));
  using Graph = decltype(graph);
  const Graph::Face_index first = *graph.faces_begin();
  CGAL::Euler::remove_face(graph.halfedge(first), graph);
  graph.remove_vertex(graph.add_vertex(Epick::Point_3(9, 9, 9)));
  graph.add_vertex(Epick::Point_3(7, 7, 7));
  REQUIRE(graph.has_garbage());
  const TriangleMesh mesh = adapter::triangle_mesh(graph);
  CHECK(mesh.faces.size() == 11);
  CHECK(mesh.vertices.size() == 9);
  CHECK(mesh.vertices.back() == Vector3d(7, 7, 7));
}

TEST_CASE("Points of Epeck are rounded to doubles, others kept", "[geometry][cgal]") {
  CHECK(adapter::vector(Plain::Point_3(0.1, -0.2, 0.3)) == Vector3d(0.1, -0.2, 0.3));
  CHECK(adapter::vector(adapter::point({0.1, -0.2, 0.3})) == Vector3d(0.1, -0.2, 0.3));
  const Epeck::FT third = Epeck::FT(1) / 3;
  const Vector3d rounded = adapter::vector(Epeck::Point_3(third, 2, third));
  CHECK(std::abs(rounded.x() - 1.0 / 3.0) <= 0x1p-54);
  CHECK(rounded.y() == 2.0);
}

TEST_CASE("What is no triangle mesh is refused by its first fault", "[geometry][cgal]") {
  SurfaceMesh<Epick> quad;
  std::vector<SurfaceMesh<Epick>::Vertex_index> corners;
  for (const auto& [x, y] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
    corners.push_back(quad.add_vertex(Epick::Point_3(x, y, 0)));
  }
  quad.add_face(corners[0], corners[1], corners[2], corners[3]);
  CHECK(refusal([&] { adapter::triangle_mesh(quad); }) ==
        "face 0 has 4 corners, must have 3: triangulate the mesh first");
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  quad.add_vertex(Epick::Point_3(0, kNan, 0));
  CHECK(refusal([&] { adapter::triangle_mesh(quad); }) == "vertex 4 is not finite");

  TriangleMesh fan{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}}, {}};
  fan.faces = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};  // three faces at an edge
  CHECK_THAT(refusal([&] { adapter::face_graph(fan); }),
             Contains("face 2 (0, 1, 4) makes an edge or a vertex non-manifold"));
  fan.faces = {{0, 1, 2}, {3, 3, 4}};
  CHECK_THAT(refusal([&] { adapter::face_graph(fan); }), Contains("face 1 (3, 3, 4)"));
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
        }) == "face 0 has vertex 3 of 3");
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
  // A corner of the cube: three squares of 0.5.
  const auto box =
      adapter::volume(Epeck::Iso_cuboid_3(Epeck::Point_3(0.5, 0.5, 0.5), Epeck::Point_3(2, 2, 2)));
  CHECK(area_in(box) == Approx(0.75).epsilon(1e-12));
  // x + y <= 1 and z >= 1, as planes with their negative sides: half of the upper square of 4, and
  // a triangle of 1/2 less where x + y > 1 - that is all of it but the corner triangle.
  const std::vector<Epick::Plane_3> planes = {Epick::Plane_3(1, 1, 0, -1),
                                              Epick::Plane_3(0, 0, -1, 1)};
  CHECK(area_in(adapter::volume_of_planes(planes)) == Approx(3.5).epsilon(1e-12));
}

TEST_CASE("CGAL's tree and MeshQuery find the same nearest points", "[geometry][cgal]") {
  const TriangleMesh mesh = geometry::torus(0.05, 0.02, 48, 24);
  const geometry::MeshQuery query(mesh);
  adapter::FaceTree first(mesh);
  const adapter::FaceTree tree = std::move(first);  // its triangles stay where they are
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
}

}  // namespace graspfit::test_cgal_adapter
