#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

using namespace graspfit::geometry;

namespace {

void turn(TriangleMesh& mesh, std::size_t face) {
  std::swap(mesh.faces[face][1], mesh.faces[face][2]);
}

TriangleMesh inward(TriangleMesh mesh) {
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) turn(mesh, face);
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, const Eigen::Vector3d& by) {
  for (auto& vertex : mesh.vertices) vertex += by;
  return mesh;
}

}  // namespace

TEST_CASE("Shapes are closed, manifold and outward", "[geometry][mesh_analysis]") {
  for (const TriangleMesh& mesh :
       {ball(1, 2), box({1, 2, 3}), torus(2, 1, 12, 8), cylinder(1, 2, 12), capsule(1, 2, 12)}) {
    const MeshAnalysis analysis = analyze(mesh, {.count_self_intersections = true});
    CHECK(analysis.is_closed);
    CHECK(analysis.is_manifold);
    CHECK(analysis.is_outward);
    CHECK(analysis.num_parts == 1);
    CHECK(analysis.num_vertices == mesh.vertices.size());
    CHECK(analysis.num_faces == mesh.faces.size());
    CHECK(analysis.num_unused_vertices + analysis.num_degenerate_faces +
              analysis.num_doubled_faces + analysis.num_boundary_edges +
              analysis.num_nonmanifold_edges + analysis.num_inconsistent_edges +
              analysis.num_inward_parts ==
          0);
    CHECK(analysis.num_self_intersections == 0);
    CHECK(analysis.box.isApprox(bounding_box(mesh)));
  }
}

TEST_CASE("Each defect of a box is counted", "[geometry][mesh_analysis]") {
  const TriangleMesh cube = box({1, 1, 1});
  TriangleMesh mesh = cube;
  mesh.faces.pop_back();
  CHECK(analyze(mesh).num_boundary_edges == 3);
  CHECK_FALSE(analyze(mesh).is_closed);
  CHECK(analyze(mesh).is_manifold);

  mesh = cube;
  turn(mesh, 4);
  CHECK(analyze(mesh).num_inconsistent_edges == 3);
  CHECK_FALSE(analyze(mesh).is_closed);

  mesh = cube;
  mesh.faces.push_back({mesh.faces[3][1], mesh.faces[3][0], mesh.faces[3][2]});
  CHECK(analyze(mesh).num_doubled_faces == 1);
  CHECK(analyze(mesh).num_nonmanifold_edges == 3);
  CHECK_FALSE(analyze(mesh).is_manifold);

  mesh = cube;
  mesh.faces.push_back({0, 1, 1});
  mesh.vertices.push_back({0, 0, 0});
  CHECK(analyze(mesh).num_degenerate_faces == 1);
  CHECK(analyze(mesh).num_unused_vertices == 1);

  CHECK(analyze(inward(cube)).num_inward_parts == 1);
  CHECK(analyze(inward(cube)).is_closed);
  CHECK_FALSE(analyze(inward(cube)).is_outward);
}

TEST_CASE("Collinear corners are degenerate however far apart", "[geometry][mesh_analysis]") {
  TriangleMesh mesh;
  mesh.vertices = {{0.1, 0.2, 0.3}, {0.2, 0.4, 0.6}, {0.4, 0.8, 1.2}};
  mesh.faces = {{0, 1, 2}};
  CHECK(analyze(mesh).num_degenerate_faces == 1);
  mesh.vertices[1][0] = std::nextafter(mesh.vertices[1][0], 1.0);
  CHECK(analyze(mesh).num_degenerate_faces == 0);
}

TEST_CASE("An inward part is right as a cavity and wrong elsewhere", "[geometry][mesh_analysis]") {
  const TriangleMesh outer = box({4, 4, 4});
  const TriangleMesh inner = inward(box({1, 1, 1}));
  const MeshAnalysis hollow = analyze(concatenated({outer, inner}));
  CHECK(hollow.num_parts == 2);
  CHECK(hollow.num_inward_parts == 0);
  CHECK(hollow.is_outward);
  CHECK(analyze(concatenated({outer, moved(inner, {5, 0, 0})})).num_inward_parts == 1);
}

TEST_CASE("Two boxes with a common vertex are pinched there", "[geometry][mesh_analysis]") {
  TriangleMesh both = concatenated({box({1, 1, 1}), moved(box({1, 1, 1}), {1, 1, 1})});
  CHECK(analyze(both).is_manifold);  // Two vertices at one place are two.
  for (Face& f : both.faces) {
    for (std::int32_t& vertex : f) vertex = vertex == 8 ? 7 : vertex;
  }
  const MeshAnalysis pinched = analyze(both);
  CHECK(pinched.is_closed);
  CHECK_FALSE(pinched.is_manifold);
  CHECK(pinched.num_nonmanifold_edges == 0);
}

TEST_CASE("Crossing parts are counted as self-intersections only when asked",
          "[geometry][mesh_analysis]") {
  const TriangleMesh crossing =
      concatenated({box({2, 2, 2}), moved(box({2, 2, 2}), {1, 0.5, 0.25})});
  CHECK_FALSE(analyze(crossing).num_self_intersections.has_value());
  CHECK(*analyze(crossing, {.count_self_intersections = true}).num_self_intersections > 0);
  const TriangleMesh apart = concatenated({box({2, 2, 2}), moved(box({2, 2, 2}), {3, 0, 0})});
  CHECK(*analyze(apart, {.count_self_intersections = true}).num_self_intersections == 0);
}

TEST_CASE("A mesh of nothing is not closed", "[geometry][mesh_analysis]") {
  const MeshAnalysis analysis = analyze(TriangleMesh{});
  CHECK(analysis.num_parts == 0);
  CHECK_FALSE(analysis.is_closed);
  CHECK_FALSE(analysis.is_outward);
  CHECK(analysis.box.isEmpty());
}
