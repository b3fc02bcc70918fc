#include <string>

#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/mass_properties.hpp"
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

std::string steps_of(const RepairedMesh& repaired) {
  std::string text;
  for (const RepairStep& step : repaired.steps) {
    text += (text.empty() ? "" : ", ") + step.what + " " + std::to_string(step.count);
  }
  return text;
}

void check_is_good(const RepairedMesh& repaired, double volume) {
  CHECK(repaired.after.is_closed);
  CHECK(repaired.after.is_manifold);
  CHECK(repaired.after.is_outward);
  CHECK(signed_volume(repaired.mesh) == Approx(volume));
  // Repairing again changes nothing.
  const RepairedMesh again = repair_mesh(repaired.mesh);
  CHECK(again.steps.empty());
  CHECK(again.mesh == repaired.mesh);
}

}  // namespace

TEST_CASE("A good mesh is left as it is", "[geometry][mesh_repair]") {
  const TriangleMesh mesh = torus(2, 1, 12, 8);
  for (const RepairMode mode : {RepairMode::Repair, RepairMode::Strict, RepairMode::AsIs}) {
    const RepairedMesh repaired = repair_mesh(mesh, {.mode = mode});
    CHECK(repaired.mesh == mesh);
    CHECK(repaired.steps.empty());
  }
}

TEST_CASE("A hole of a box is filled and the volume restored", "[geometry][mesh_repair]") {
  TriangleMesh mesh = box({1, 1, 4});
  // Without its bottom plate: a square hole of extent 1 against 4.
  mesh.faces.erase(mesh.faces.begin(), mesh.faces.begin() + 2);
  const RepairedMesh repaired = repair_mesh(mesh);
  CHECK(steps_of(repaired) == "filled holes 1");
  CHECK(repaired.before.num_boundary_edges == 4);
  check_is_good(repaired, 4.0);
  CHECK_THROWS_WITH(repair_mesh(mesh, {.max_hole_extent_rel = 0.2}),
                    Catch::Contains("4 boundary edges") && Catch::Contains("0.25"));
}

TEST_CASE("Turned faces and parts are turned back", "[geometry][mesh_repair]") {
  TriangleMesh mesh = ball(1, 1);
  turn(mesh, 3);
  turn(mesh, 40);
  CHECK(steps_of(repair_mesh(mesh)) == "turned faces 2");
  check_is_good(repair_mesh(mesh), signed_volume(ball(1, 1)));

  const RepairedMesh outward = repair_mesh(inward(box({1, 2, 3})));
  CHECK(steps_of(outward) == "turned parts 1");
  CHECK(outward.steps[0].volume_change == Approx(12.0));
  check_is_good(outward, 6.0);
}

TEST_CASE("A cavity stays, an inside-out neighbor is turned", "[geometry][mesh_repair]") {
  const TriangleMesh cube = box({4, 4, 4});
  const TriangleMesh hollow = concatenated({cube, inward(box({2, 2, 2}))});
  CHECK(repair_mesh(hollow).mesh == hollow);
  check_is_good(repair_mesh(concatenated({cube, moved(inward(cube), {5, 0, 0})})), 128.0);
}

TEST_CASE("Doubled, degenerate and unused things are dropped", "[geometry][mesh_repair]") {
  TriangleMesh mesh = box({1, 1, 1});
  mesh.faces.push_back(mesh.faces[2]);
  mesh.faces.push_back({mesh.faces[5][1], mesh.faces[5][2], mesh.faces[5][0]});
  mesh.faces.push_back({3, 3, 5});
  mesh.vertices.push_back({9, 9, 9});
  const RepairedMesh repaired = repair_mesh(mesh);
  CHECK(steps_of(repaired) ==
        "removed degenerate faces 1, removed doubled faces 2, removed unused vertices 1");
  CHECK(repaired.mesh == box({1, 1, 1}));
}

TEST_CASE("A flap of two opposite faces goes entirely", "[geometry][mesh_repair]") {
  TriangleMesh mesh = box({1, 1, 1});
  mesh.vertices.push_back({2, 2, 2});
  mesh.faces.push_back({0, 1, 8});
  mesh.faces.push_back({1, 0, 8});
  check_is_good(repair_mesh(mesh), 1.0);
}

TEST_CASE("A mesh drawn on both sides becomes one surface", "[geometry][mesh_repair]") {
  TriangleMesh mesh = box({1, 1, 1});
  for (const Face& f : inward(mesh).faces) mesh.faces.push_back(f);
  check_is_good(repair_mesh(mesh), 1.0);
}

TEST_CASE("Solids that touch along an edge or at a vertex come apart", "[geometry][mesh_repair]") {
  const TriangleMesh cube = box({1, 1, 1});
  // The edge from 3 to 7 of the first box (x = y = 1/2) is the edge from 0 to 4 of the second.
  TriangleMesh along_edge = concatenated({cube, moved(cube, {1, 1, 0})});
  TriangleMesh at_vertex = concatenated({cube, moved(cube, {1, 1, 1})});
  for (Face& f : along_edge.faces) {
    for (std::int32_t& v : f) v = v == 8 ? 3 : v == 12 ? 7 : v;
  }
  for (Face& f : at_vertex.faces) {
    for (std::int32_t& v : f) v = v == 8 ? 7 : v;
  }
  const RepairedMesh edge = repair_mesh(along_edge);
  CHECK(edge.before.num_nonmanifold_edges == 1);
  CHECK(edge.after.num_parts == 2);
  check_is_good(edge, 2.0);
  const RepairedMesh vertex = repair_mesh(at_vertex);
  CHECK(vertex.before.num_nonmanifold_edges == 0);
  CHECK_FALSE(vertex.before.is_manifold);
  check_is_good(vertex, 2.0);
}

TEST_CASE("What cannot be repaired is refused in one line", "[geometry][mesh_repair]") {
  TriangleMesh half = ball(1, 2);
  std::erase_if(half.faces, [&](const Face& f) { return half.vertices[f[0]][2] < 0.0; });
  CHECK_THROWS_AS(repair_mesh(half), InvalidInput);

  // A Möbius strip has one side.
  TriangleMesh strip;
  for (int i = 0; i < 6; ++i) {
    const double angle = i * 3.14159265358979 / 3.0;
    const Eigen::Vector3d radial(std::cos(angle), std::sin(angle), 0.0);
    const Eigen::Vector3d across =
        0.3 * (std::cos(angle / 2) * radial + std::sin(angle / 2) * Eigen::Vector3d::UnitZ());
    strip.vertices.push_back(radial + across);
    strip.vertices.push_back(radial - across);
  }
  for (int i = 0; i < 6; ++i) {
    const int a = 2 * i, b = 2 * i + 1;
    const int c = i < 5 ? a + 2 : 1, d = i < 5 ? b + 2 : 0;
    strip.faces.push_back({a, b, c});
    strip.faces.push_back({b, d, c});
  }
  CHECK_THROWS_AS(repair_mesh(strip, {.max_hole_extent_rel = 1.0}), InvalidInput);

  CHECK_THROWS_WITH(repair_mesh(TriangleMesh{}), "the mesh has no faces");
  TriangleMesh pillow;
  pillow.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, 0}};
  pillow.faces = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}};
  CHECK_THROWS_AS(repair_mesh(pillow), DegenerateGeometry);
}

TEST_CASE("Strict refuses any defect and as-is keeps every one", "[geometry][mesh_repair]") {
  TriangleMesh mesh = box({1, 1, 1});
  mesh.vertices.push_back({9, 9, 9});
  CHECK_THROWS_WITH(repair_mesh(mesh, {.mode = RepairMode::Strict}),
                    Catch::Contains("1 unused vertices"));
  CHECK(repair_mesh(mesh, {.mode = RepairMode::AsIs}).mesh == mesh);
  mesh.faces.pop_back();
  CHECK_THROWS_AS(repair_mesh(mesh, {.mode = RepairMode::Strict}), InvalidInput);
  const RepairedMesh as_is = repair_mesh(mesh, {.mode = RepairMode::AsIs});
  CHECK(as_is.mesh == mesh);
  CHECK_FALSE(as_is.after.is_closed);
}

TEST_CASE("Repair options out of range are refused", "[geometry][mesh_repair]") {
  for (const double bad : {-0.1, 1.1, std::nan("")}) {
    CHECK_THROWS_AS(repair_mesh(box({1, 1, 1}), {.max_hole_extent_rel = bad}), InvalidInput);
  }
}
