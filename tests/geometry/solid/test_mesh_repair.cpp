#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "geometry/changed_meshes.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/mesh_repair.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/surface_distance.hpp"
#include "solid/mesh_holes.hpp"
#include "solid/misfilled_share.hpp"
#include "support/catch.hpp"

namespace test_mesh_repair {

using namespace graspfit::base;
using namespace graspfit::geometry;
using graspfit::testing::inward;
using graspfit::testing::moved;
using graspfit::testing::turn;

namespace {

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

/// Returns every face with three vertices of its own.
TriangleMesh soup(const TriangleMesh& mesh) {
  TriangleMesh result;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const auto first = static_cast<std::int32_t>(result.vertices.size());
    for (const Eigen::Vector3d& corner : corners(mesh, face)) result.vertices.push_back(corner);
    result.faces.push_back({first, first + 1, first + 2});
  }
  return result;
}

/// Checks that the steps' volumes add up, and that their bounds hold against the surfaces
/// themselves.
void check_report(const TriangleMesh& given, const RepairedMesh& repaired) {
  double volume = internal::coned_volume(given);
  double bound = 0.0;
  for (const RepairStep& step : repaired.steps) {
    CHECK(step.count > 0);
    CHECK(step.hausdorff_bound >= 0.0);
    volume += step.volume_change;
    bound += step.hausdorff_bound;
  }
  CHECK(volume == Approx(signed_volume(repaired.mesh)));
  const double tolerance = 1e-5 * longest_extent(given);
  const HausdorffDistance distance =
      hausdorff_distance(MeshQuery(given), MeshQuery(repaired.mesh), {.tolerance = tolerance});
  CHECK(distance.lower <= bound + 1e-13 * longest_extent(given));
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
  // Without its bottom plate the mesh has a square hole of extent 1 against 4.
  mesh.faces.erase(mesh.faces.begin(), mesh.faces.begin() + 2);
  const RepairedMesh repaired = repair_mesh(mesh);
  CHECK(steps_of(repaired) == "filled holes 1");
  CHECK(repaired.before.num_boundary_edges == 4);
  check_is_good(repaired, 4.0);
  CHECK_THROWS_WITH(
      repair_mesh(mesh, {.max_hole_extent_rel = 0.2}),
      graspfit::testing::Contains("4 boundary edges") && graspfit::testing::Contains("0.25"));
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

TEST_CASE("Solids with a common side cut along other diagonals come apart",
          "[geometry][mesh_repair]") {
  // The second box stands on the top of the first and shares its four corners there, 4 to 7. Since
  // it is turned by a quarter, its bottom has the other diagonal. Around their common edges two
  // faces stand in one place.
  TriangleMesh upper = box({1, 1, 1});
  for (Eigen::Vector3d& v : upper.vertices) v = Eigen::Vector3d(-v[1], v[0], v[2] + 1.0);
  const TriangleMesh lower = box({1, 1, 1});
  TriangleMesh both = concatenated({lower, upper});
  for (Face& f : both.faces) {
    for (std::int32_t& v : f) {
      for (std::int32_t top = 4; top < 8; ++top) {
        if (both.vertices[v] == both.vertices[top]) v = top;
      }
    }
  }
  const RepairedMesh repaired = repair_mesh(both);
  CHECK(repaired.before.num_nonmanifold_edges == 4);
  CHECK(steps_of(repaired) == "welded vertices 4, split non-manifold vertices 4");
  CHECK(repaired.after.num_parts == 2);
  check_is_good(repaired, 2.0);
}

TEST_CASE("A slit without area is filled with faces without area", "[geometry][mesh_repair]") {
  // There are one to three vertices on an edge of the neighbor.
  for (const int num_extra : {1, 2, 3}) {
    TriangleMesh mesh = box({1, 1, 4});
    const Face face = mesh.faces[5];
    mesh.faces.erase(mesh.faces.begin() + 5);
    std::int32_t last = face[0];
    for (int i = 1; i <= num_extra; ++i) {
      const double t = i / 4.0;  // This is exact, as the box's coordinates are powers of two.
      mesh.vertices.push_back((1.0 - t) * mesh.vertices[face[0]] + t * mesh.vertices[face[1]]);
      const auto next = static_cast<std::int32_t>(mesh.vertices.size()) - 1;
      mesh.faces.push_back({last, next, face[2]});
      last = next;
    }
    mesh.faces.push_back({last, face[1], face[2]});
    const RepairedMesh repaired = repair_mesh(mesh, {.max_hole_extent_rel = 1.0});
    CHECK(steps_of(repaired) == "filled holes 1");
    CHECK(repaired.steps[0].hausdorff_bound == 0.0);
    CHECK(repaired.after.num_degenerate_faces == static_cast<std::size_t>(num_extra));
    check_is_good(repaired, 4.0);
  }
}

TEST_CASE("What cannot be repaired is refused in one line", "[geometry][mesh_repair]") {
  TriangleMesh half = ball(1, 2);
  std::erase_if(half.faces, [&](const Face& f) { return half.vertices[f[0]][2] < 0.0; });
  CHECK_THROWS_AS(repair_mesh(half), InvalidInput);

  // A Möbius strip has one side.
  TriangleMesh strip;
  for (int i = 0; i < 6; ++i) {
    const double angle = i * std::numbers::pi / 3.0;
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
                    graspfit::testing::Contains("1 unused vertices"));
  CHECK(repair_mesh(mesh, {.mode = RepairMode::AsIs}).mesh == mesh);
  mesh.faces.pop_back();
  CHECK_THROWS_AS(repair_mesh(mesh, {.mode = RepairMode::Strict}), InvalidInput);
  const RepairedMesh as_is = repair_mesh(mesh, {.mode = RepairMode::AsIs});
  CHECK(as_is.mesh == mesh);
  CHECK_FALSE(as_is.after.is_closed);
}

TEST_CASE("Repair options out of range are refused by name", "[geometry][mesh_repair]") {
  const TriangleMesh mesh = box({1, 1, 1});
  for (const double bad : {-0.1, 1.1, std::nan("")}) {
    CHECK_THROWS_WITH(repair_mesh(mesh, {.max_hole_extent_rel = bad}),
                      graspfit::testing::Contains("max_hole"));
    CHECK_THROWS_WITH(repair_mesh(mesh, {.max_misfilled_rel = bad}),
                      graspfit::testing::Contains("max_misfilled_rel"));
    CHECK_THROWS_WITH(repair_mesh(mesh, {.max_removed_rel = bad}),
                      graspfit::testing::Contains("max_removed_rel"));
    CHECK_THROWS_WITH(repair_mesh(mesh, {.weld_distance_rel = bad}),
                      graspfit::testing::Contains("weld"));
    CHECK_THROWS_WITH(repair_mesh(mesh, {.wrap = AlphaWrap{.alpha_rel = bad}}),
                      graspfit::testing::Contains("alpha_rel"));
    CHECK_THROWS_WITH(repair_mesh(mesh, {.wrap = AlphaWrap{.offset_rel = bad}}),
                      graspfit::testing::Contains("offset_rel"));
  }
}

TEST_CASE("Equal vertices are welded, zeros of either sign too", "[geometry][mesh_repair]") {
  TriangleMesh mesh = soup(moved(box({1, 1, 1}), {0.5, 0.5, 0.5}));
  for (std::size_t v = 0; v < mesh.vertices.size(); v += 2) {
    for (double& x : mesh.vertices[v]) x = x == 0.0 ? -0.0 : x;
  }
  const RepairedMesh repaired = repair_mesh(mesh);
  CHECK(steps_of(repaired) == "welded vertices 28");
  CHECK(repaired.steps[0].hausdorff_bound == 0.0);
  check_is_good(repaired, 1.0);
  for (const Eigen::Vector3d& vertex : repaired.mesh.vertices) {
    for (const double x : vertex) CHECK_FALSE(std::signbit(x));
  }
}

TEST_CASE("Vertices are welded up to the distance given and move no farther",
          "[geometry][mesh_repair]") {
  TriangleMesh mesh = soup(ball(1, 1));
  Random random(3);
  // Vertices are up to 0.8e-3 apart; the extent is 2, so that 0.0005 welds what is 1e-3 apart.
  for (Eigen::Vector3d& v : mesh.vertices) {
    for (double& x : v) x += random.uniform(-2e-4, 2e-4);
  }
  // Without a weld every face is a sheet that what fills it cancels.
  CHECK_THROWS_AS(repair_mesh(mesh), DegenerateGeometry);
  const RepairedMesh repaired = repair_mesh(mesh, {.weld_distance_rel = 5e-4});
  CHECK(steps_of(repaired) == "welded vertices 198");
  CHECK(repaired.mesh.vertices.size() == 42);
  CHECK(repaired.steps[0].hausdorff_bound > 0.0);
  CHECK(repaired.steps[0].hausdorff_bound <= 1.001e-3);
  check_report(mesh, repaired);
  check_is_good(repaired, signed_volume(repaired.mesh));
}

TEST_CASE("A chain of close vertices does not collapse into one", "[geometry][mesh_repair]") {
  // Neighbors on a fine ring of a cylinder are 0.0157 apart, and the weld reaches to every other
  // one.
  TriangleMesh mesh = cylinder(1, 2.5, 400);
  mesh.vertices.push_back({0, 0, 0});
  const RepairedMesh repaired = repair_mesh(mesh, {.weld_distance_rel = 0.009});
  CHECK(repaired.steps[0].hausdorff_bound <= 0.009 * 2.5 * 1.001);
  CHECK(signed_volume(repaired.mesh) == Approx(signed_volume(mesh)).epsilon(1e-3));
  check_report(mesh, repaired);
}

TEST_CASE("The bound of a step is the distance where that is known", "[geometry][mesh_repair]") {
  TriangleMesh open = box({1, 1, 4});
  open.faces.erase(open.faces.begin(), open.faces.begin() + 2);
  const RepairedMesh filled = repair_mesh(open);
  // The middle of the plate is half its edge from the rim.
  CHECK(filled.steps.at(0).hausdorff_bound == Approx(0.5).margin(1e-3));
  CHECK(filled.steps.at(0).hausdorff_bound >= 0.5);
  check_report(open, filled);

  TriangleMesh flap = box({1, 1, 1});
  flap.vertices.push_back({2, 2, 2});
  flap.faces.push_back({0, 1, 8});
  flap.faces.push_back({1, 0, 8});
  const RepairedMesh trimmed = repair_mesh(flap);
  CHECK(steps_of(trimmed) == "removed doubled faces 2, removed unused vertices 1");
  CHECK(trimmed.steps[0].hausdorff_bound == Approx(1.5 * std::sqrt(3.0)).epsilon(1e-3));
  CHECK(trimmed.steps[1].hausdorff_bound == 0.0);
  check_report(flap, trimmed);

  // One face is collapsed to a diagonal through the box, one to an edge, one to a point.
  for (const auto& [face, bound] :
       {std::pair{Face{0, 0, 7}, 0.5}, std::pair{Face{0, 1, 1}, 0.0}, {Face{3, 3, 3}, 0.0}}) {
    TriangleMesh mesh = box({1, 1, 1});
    mesh.faces.push_back(face);
    const RepairedMesh repaired = repair_mesh(mesh);
    CHECK(steps_of(repaired) == "removed degenerate faces 1");
    CHECK(repaired.steps[0].hausdorff_bound == Approx(bound).margin(1e-3));
  }
}

TEST_CASE("Inside-out parts among thousands are told from cavities", "[geometry][mesh_repair]") {
  std::vector<TriangleMesh> parts = {box({100, 100, 100})};
  const TriangleMesh hole = inward(box({0.5, 0.5, 0.5}));
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d at(i % 10 - 4.5, i / 10 % 10 - 4.5, i / 100 - 4.5);
    parts.push_back(moved(hole, at));
    parts.push_back(moved(hole, at + Eigen::Vector3d(100, 0, 0)));
  }
  const RepairedMesh repaired = repair_mesh(concatenated(parts));
  CHECK(repaired.before.num_parts == 2001);
  CHECK(steps_of(repaired) == "turned parts 1000");
  check_is_good(repaired, 1e6);
  // A part that only starts inside another is no cavity.
  const RepairedMesh poking = repair_mesh(concatenated({box({4, 4, 4}), moved(hole, {2, 0, 0})}));
  CHECK(steps_of(poking) == "turned parts 1");
}

TEST_CASE("Crossings are reported as asked and refused by strict", "[geometry][mesh_repair]") {
  const TriangleMesh two = concatenated({box({2, 2, 2}), moved(box({2, 2, 2}), {1, 0.5, 0.25})});
  CHECK_FALSE(repair_mesh(two).before.num_self_intersections.has_value());
  CHECK(repair_mesh(two, {.mode = RepairMode::Strict}).mesh == two);
  for (const RepairMode mode : {RepairMode::Repair, RepairMode::AsIs}) {
    const RepairedMesh reported =
        repair_mesh(two, {.mode = mode, .self_intersections = SelfIntersections::Report});
    CHECK(reported.mesh == two);
    CHECK(*reported.before.num_self_intersections > 0);
    CHECK(reported.before.num_self_intersections == reported.after.num_self_intersections);
  }
  for (const auto choice : {SelfIntersections::Report, SelfIntersections::Resolve}) {
    CHECK_THROWS_WITH(repair_mesh(two, {.mode = RepairMode::Strict, .self_intersections = choice}),
                      graspfit::testing::Contains("pairs of crossing faces"));
    CHECK(repair_mesh(box({1, 1, 1}), {.mode = RepairMode::Strict, .self_intersections = choice})
              .steps.empty());
  }
}

TEST_CASE("Resolving crossings keeps the solid and leaves none", "[geometry][mesh_repair]") {
  const TriangleMesh cube = box({2, 2, 2});
  // One vertex is pushed through the opposite side.
  TriangleMesh dented = ball(1, 2);
  dented.vertices[5] *= -1.3;
  const RigidTransform X(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  const MeshRepairOptions resolve{.self_intersections = SelfIntersections::Resolve};
  for (const TriangleMesh& mesh :
       {concatenated({cube, moved(cube, {1, 0.5, 0.25})}),
        concatenated({cube, moved(cube, {1, 0, 0})}),
        concatenated({cube, transformed(cube, X), ball(1.2, 2)}), dented,
        concatenated(
            {torus(2, 0.7, 24, 12), cube, moved(inward(box({0.5, 0.5, 0.5})), {2, 0, 0})})}) {
    const RepairedMesh repaired = repair_mesh(mesh, resolve);
    REQUIRE(repaired.steps.size() == 1);
    CHECK(repaired.steps[0].what == "resolved self-intersections");
    CHECK(repaired.steps[0].count == *repaired.before.num_self_intersections);
    CHECK(*repaired.after.num_self_intersections == 0);
    CHECK(repaired.after.is_outward);
    CHECK(repaired.after.is_manifold);
    check_report(mesh, repaired);
    const MeshQuery before(mesh);
    const MeshQuery after(repaired.mesh);
    Random random(17);
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector3d p(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-2, 2));
      REQUIRE(before.containment(p) == after.containment(p));
    }
    CHECK(repair_mesh(repaired.mesh, resolve).mesh == repaired.mesh);
  }
}

TEST_CASE("A wrap closes what nothing else does, around all of it", "[geometry][mesh_repair]") {
  TriangleMesh half = ball(1, 2);
  std::erase_if(half.faces, [&](const Face& f) { return half.vertices[f[0]][2] < 0.0; });
  TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  sheet.faces = {{0, 1, 2}};
  TriangleMesh tray = box({1, 1, 1});
  tray.faces.erase(tray.faces.begin(), tray.faces.begin() + 2);
  const AlphaWrap wrap{.alpha_rel = 0.2, .offset_rel = 0.02};
  for (const TriangleMesh& mesh : {half, sheet, tray}) {
    CHECK_THROWS_AS(repair_mesh(mesh), Error);
    CHECK_THROWS_AS(repair_mesh(mesh, {.mode = RepairMode::Strict, .wrap = wrap}), InvalidInput);
    const RepairedMesh repaired = repair_mesh(mesh, {.wrap = wrap});
    CHECK(steps_of(repaired) == "wrapped " + std::to_string(repaired.mesh.faces.size()));
    check_is_good(repaired, signed_volume(repaired.mesh));
    check_report(mesh, repaired);
    CHECK(repaired.steps[0].hausdorff_bound >= 0.02 * longest_extent(mesh));
    const MeshQuery query(repaired.mesh);
    for (const Face& face : mesh.faces) {
      for (const std::int32_t v : face) {
        CHECK(query.containment(mesh.vertices[v]) == Containment::Inside);
      }
    }
  }
  // Wrapping is not the first resort.
  TriangleMesh turned = box({1, 1, 1});
  turn(turned, 2);
  CHECK(steps_of(repair_mesh(turned, {.wrap = wrap})) == "turned faces 1");
  CHECK(repair_mesh(turned, {.mode = RepairMode::AsIs, .wrap = wrap}).mesh == turned);
}

TEST_CASE("Filling a flat hole changes no volume, wherever the mesh stands",
          "[geometry][mesh_repair]") {
  TriangleMesh open = box({1, 1, 4});
  std::erase_if(open.faces, [&](const Face& f) {
    return std::all_of(f.begin(), f.end(), [&](auto v) { return open.vertices[v][2] > 0.0; });
  });
  REQUIRE(open.faces.size() == 10);
  for (const Eigen::Vector3d& place : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(7, -3, 20)}) {
    const RepairedMesh repaired = repair_mesh(moved(open, place));
    CHECK(steps_of(repaired) == "filled holes 1");
    CHECK(std::abs(repaired.steps[0].volume_change) < 1e-13);
    CHECK(repaired.steps[0].hausdorff_bound == Approx(0.5).epsilon(1e-3));
  }
}

TEST_CASE("What a filling misses is the volume between it and the surface's own solid",
          "[geometry][mesh_repair]") {
  const auto triangles = [](const TriangleMesh& mesh, auto&& is_filling) {
    std::vector<std::array<Eigen::Vector3d, 3>> found;
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
      const auto c = corners(mesh, face);
      if (std::all_of(c.begin(), c.end(), is_filling)) found.push_back(c);
    }
    return found;
  };
  // A flat filling, which is open to all above it, misses nothing.
  const TriangleMesh block = box({1, 1, 1});
  const auto lid = triangles(block, [](const Eigen::Vector3d& p) { return p[2] == 0.5; });
  REQUIRE(lid.size() == 2);
  CHECK(internal::misfilled_share(block, lid) == 0.0);
  CHECK(internal::misfilled_share(block, {}) == 0.0);
  // A pit of square section is under a square hole. From within it the hole covers less than half
  // of all directions, so that all of the pit is inside what the surface means.
  for (const double depth : {0.25, 0.5, 0.75}) {
    constexpr double kHalf = 0.375;
    TriangleMesh pitted;
    for (const double half : {0.5, kHalf}) {
      for (const double z : {half == 0.5 ? -0.5 : 0.5 - depth, 0.5}) {
        for (const double y : {-half, half}) {
          for (const double x : {-half, half}) pitted.vertices.emplace_back(x, y, z);
        }
      }
    }
    const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
      pitted.faces.push_back({a, b, c});
      pitted.faces.push_back({a, c, d});
    };
    const std::array<std::int32_t, 4> around = {0, 1, 3, 2};
    add(0, 2, 3, 1);
    add(8, 9, 11, 10);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::int32_t a = around[k];
      const std::int32_t b = around[(k + 1) % 4];
      add(a, b, b + 4, a + 4);
      add(a + 4, b + 4, b + 12, a + 12);
      add(a + 12, b + 12, b + 8, a + 8);
    }
    const double pit = 4.0 * kHalf * kHalf * depth;
    REQUIRE(analyze(pitted).is_outward);
    REQUIRE(signed_volume(pitted) == Approx(1.0 - pit));
    const auto filling = triangles(pitted, [](const Eigen::Vector3d& p) {
      return std::abs(p[0]) == kHalf && std::abs(p[1]) == kHalf;
    });
    REQUIRE(filling.size() == 10);
    CHECK(internal::misfilled_share(pitted, filling) == Approx(pit).margin(0.05));
  }
}

TEST_CASE("A wrap scales with its mesh by powers of two, to the bit, and ends at any size",
          "[geometry][mesh_repair]") {
  TriangleMesh open = box({1, 2, 3});
  open.faces.pop_back();
  const MeshRepairOptions options{.max_hole_extent_rel = 0.0,
                                  .wrap = AlphaWrap{.alpha_rel = 0.2, .offset_rel = 0.05}};
  const TriangleMesh wrapped = repair_mesh(open, options).mesh;
  const auto scaled = [](TriangleMesh mesh, int exponent) {
    for (Eigen::Vector3d& vertex : mesh.vertices) {
      for (double& x : vertex) x = std::ldexp(x, exponent);
    }
    return mesh;
  };
  for (const int exponent : {-60, 60}) {
    CHECK(repair_mesh(scaled(open, exponent), options).mesh == scaled(wrapped, exponent));
  }
  // Volumes are beyond the range of doubles.
  for (const int exponent : {-1000, 1000}) {
    CHECK_THROWS_AS(repair_mesh(scaled(open, exponent), options), InvalidInput);
  }
}

TEST_CASE("A refusal names the limit for holes that does, and only if it does",
          "[geometry][mesh_repair]") {
  const auto message = [](const TriangleMesh& mesh, const MeshRepairOptions& options) {
    try {
      repair_mesh(mesh, options);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  TriangleMesh tray = box({1, 1, 1});
  tray.faces.erase(tray.faces.begin(), tray.faces.begin() + 2);
  CHECK(message(tray, {}) ==
        "the mesh is not closed and could not be repaired: 4 boundary edges; its largest hole "
        "spans 1 of its longest extent, holes up to 0.5 are filled; --max-hole 1 fills it; --wrap "
        "lays a closed surface around it");
  TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  sheet.faces = {{0, 1, 2}};
  CHECK(message(sheet, {}).find("--max-hole") == std::string::npos);
  CHECK(message(sheet, {}).ends_with("; --wrap lays a closed surface around it"));
  CHECK(message(sheet, {.max_hole_extent_rel = 1.0}) ==
        "the mesh encloses no volume: its faces cancel each other; --wrap lays a closed surface "
        "around it");
}

}  // namespace test_mesh_repair
