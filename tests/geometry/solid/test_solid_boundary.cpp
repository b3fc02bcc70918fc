#include <algorithm>
#include <map>
#include <numbers>

#include "geometry/changed_meshes.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/solid_boundary.hpp"
#include "support/catch.hpp"

namespace test_solid_boundary {

using namespace graspfit::base;
using namespace graspfit::geometry;
using graspfit::testing::inward;
using graspfit::testing::moved;

namespace {

/// Returns how often every edge is run through upward more than downward; only what is not zero
/// counts.
std::size_t num_open_edges(const TriangleMesh& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> balance;
  for (const Face& f : mesh.faces) {
    for (int i = 0; i < 3; ++i) {
      const std::int32_t a = f[i], b = f[(i + 1) % 3];
      balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  return static_cast<std::size_t>(
      std::count_if(balance.begin(), balance.end(), [](const auto& e) { return e.second != 0; }));
}

/// Checks that the boundary is closed and winds once around what the mesh winds around, and nowhere
/// else. Returns the boundary.
TriangleMesh checked_boundary(const TriangleMesh& mesh) {
  const TriangleMesh boundary = solid_boundary(mesh);
  CHECK(num_open_edges(boundary) == 0);
  const MeshQuery before(mesh);
  const MeshQuery after(boundary);
  const Eigen::AlignedBox3d box = bounding_box(mesh);
  Random random(29);
  for (int i = 0; i < 500; ++i) {
    Eigen::Vector3d p;
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] = random.uniform(box.min()[axis], box.max()[axis]);
    }
    REQUIRE(before.containment(p) == after.containment(p));
  }
  return boundary;
}

}  // namespace

TEST_CASE("A face whose area is of the size of rounding is no gap in the boundary",
          "[geometry][solid_boundary]") {
  // Two boxes cross, and vertex 8 is an ulp beside the diagonal of the first one's top, so that the
  // bounds of that sliver's normal hold zero.
  TriangleMesh mesh;
  mesh.vertices = {
      {0.1, 0.2, 0.0},   {0.95, 0.13, 0.0}, {0.9, 0.85, 0.0},
      {0.07, 0.93, 0.0}, {0.1, 0.2, 1.0},   {0.95, 0.13, 1.0},
      {0.9, 0.85, 1.0},  {0.07, 0.93, 1.0}, {0.272127437817821, 0.3398535432269796, 1.0},
      {0.41, 0.42, 0.5}, {0.63, 0.39, 0.5}, {0.61, 0.66, 0.5},
      {0.38, 0.64, 0.5}, {0.41, 0.42, 1.5}, {0.63, 0.39, 1.5},
      {0.61, 0.66, 1.5}, {0.38, 0.64, 1.5}};
  mesh.faces = {{0, 1, 5},    {0, 5, 4},    {1, 2, 6},   {1, 6, 5},    {2, 3, 7},    {2, 7, 6},
                {3, 0, 4},    {3, 4, 7},    {0, 2, 1},   {0, 3, 2},    {4, 5, 6},    {4, 8, 7},
                {8, 6, 7},    {4, 6, 8},    {9, 10, 14}, {9, 14, 13},  {10, 11, 15}, {10, 15, 14},
                {11, 12, 16}, {11, 16, 15}, {12, 9, 13}, {12, 13, 16}, {9, 11, 10},  {9, 12, 11},
                {13, 14, 15}, {13, 15, 16}};
  const TriangleMesh boundary = checked_boundary(mesh);
  CHECK(analyze(boundary).is_closed);
  // The second box stands upright with its lower half in the first one.
  const double outer =
      signed_volume({mesh.vertices, {mesh.faces.begin(), mesh.faces.begin() + 14}});
  const double inner = signed_volume({mesh.vertices, {mesh.faces.begin() + 14, mesh.faces.end()}});
  CHECK(signed_volume(boundary) == Approx(outer + 0.5 * inner).epsilon(1e-12));
}

TEST_CASE("Boxes in every position to each other are united", "[geometry][solid_boundary]") {
  const TriangleMesh cube = box({2, 2, 2});
  struct Case {
    std::vector<TriangleMesh> parts;
    double volume;
    double area;
  };
  const std::vector<Case> cases = {
      {{cube}, 8, 24},
      {{cube, cube}, 8, 24},
      {{cube, moved(cube, {5, 0, 0})}, 16, 48},
      // The overlap is 1 x 1.5 x 1.75, with nothing in one plane; the area of an overlap goes with
      // the volume.
      {{cube, moved(cube, {1, 0.5, 0.25})}, 16 - 2.625, 48 - 2 * (1.5 + 1.75 + 2.625)},
      // Four pairs of sides are in common planes; they are glued side to side, corner to corner,
      // half a side.
      {{cube, moved(cube, {1, 0, 0})}, 12, 32},
      {{cube, moved(cube, {2, 0, 0})}, 16, 40},
      {{cube, moved(cube, {2, 2, 2})}, 16, 48},
      {{cube, moved(cube, {2, 1, 0})}, 16, 44},
      {{cube, moved(cube, {2, 1, 0.5})}, 16, 48 - 2 * 1.5},
      // These are nested: they add nothing; a cavity; an island in a cavity; a cavity that touches
      // the side.
      {{cube, box({1, 1, 1})}, 8, 24},
      {{cube, inward(box({1, 1, 1}))}, 7, 30},
      {{box({4, 4, 4}), inward(cube), box({1, 1, 1})}, 57, 126},
      {{cube, moved(inward(box({1, 1, 1})), {0.5, 0, 0})}, 7, 28},
      // An inward part cancels what it shares and counts where it is alone.
      {{cube, moved(inward(cube), {1, 0, 0})}, 8, 32},
      {{inward(cube)}, 8, 24}};
  for (const auto& [parts, volume, area] : cases) {
    const TriangleMesh boundary = checked_boundary(concatenated(parts));
    CHECK(signed_volume(boundary) == Approx(volume));
    CHECK(surface_area(boundary) == Approx(area));
  }
}

TEST_CASE("Cubes stacked side to side become one block", "[geometry][solid_boundary]") {
  std::vector<TriangleMesh> cubes;
  for (int i = 0; i < 27; ++i) {
    cubes.push_back(moved(box({1, 1, 1}), Eigen::Vector3d(i % 3, i / 3 % 3, i / 9)));
  }
  const TriangleMesh block = checked_boundary(concatenated(cubes));
  CHECK(signed_volume(block) == Approx(27.0));
  CHECK(surface_area(block) == Approx(54.0));
}

TEST_CASE("Turned boxes and balls all through each other keep their solid",
          "[geometry][solid_boundary]") {
  Random random(11);
  std::vector<TriangleMesh> parts;
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector3d axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const RigidTransform X(Eigen::AngleAxisd(random.uniform(0, 3), axis.normalized()));
    const TriangleMesh part = i % 3 == 0 ? ball(0.6, 1) : box({1, 0.7, 0.5});
    parts.push_back(moved(transformed(i % 4 == 3 ? inward(part) : part, X), 0.5 * axis));
  }
  const TriangleMesh mesh = concatenated(parts);
  const TriangleMesh boundary = checked_boundary(mesh);
  // The order of the faces does not matter, nor does a turn that moves every plane.
  TriangleMesh reversed = mesh;
  std::reverse(reversed.faces.begin(), reversed.faces.end());
  CHECK(signed_volume(solid_boundary(reversed)) == Approx(signed_volume(boundary)).epsilon(1e-12));
  const RigidTransform X(Eigen::AngleAxisd(1.1, Eigen::Vector3d(3, -1, 2).normalized()));
  CHECK(signed_volume(solid_boundary(transformed(mesh, X))) ==
        Approx(signed_volume(boundary)).epsilon(1e-12));
}

TEST_CASE("Two balls have the volume of their union", "[geometry][solid_boundary]") {
  // Each loses the cap of height h = 1 - d/2, pi h² (3 - h) / 3, with d = 1.
  using std::numbers::pi;
  const double cap = pi * 0.25 * 2.5 / 3.0;
  const TriangleMesh two = concatenated({ball(1, 4), moved(ball(1, 4), {0.6, 0, 0.8})});
  // A ball of 5120 faces lacks 0.15 % of its volume.
  CHECK(signed_volume(checked_boundary(two)) == Approx(8.0 * pi / 3.0 - 2.0 * cap).epsilon(2e-3));
}

TEST_CASE("A surface that crosses itself is reduced to what bounds its solid",
          "[geometry][solid_boundary]") {
  // A pyramid's tip is pushed through its base: the part below counts though it winds backward.
  TriangleMesh spike = box({2, 2, 2});
  spike.vertices[7] = {-0.2, -0.3, -3.0};
  checked_boundary(spike);
  // A doubly wound bar is a torus that runs around twice and overlaps itself all along.
  TriangleMesh twice = torus(2, 0.5, 24, 8);
  for (Eigen::Vector3d& v : twice.vertices) {
    const double angle = 2.0 * std::atan2(v[1], v[0]);
    const double radius = std::hypot(v[0], v[1]);
    v = {radius * std::cos(angle), radius * std::sin(angle), v[2] + 0.1 * std::sin(angle / 2)};
  }
  checked_boundary(twice);
}

TEST_CASE("A mesh that crosses nothing comes back with all its faces",
          "[geometry][solid_boundary]") {
  for (const TriangleMesh& mesh : {torus(2, 1, 12, 8), box({1, 2, 3})}) {
    CHECK(solid_boundary(mesh) == mesh);
    CHECK(solid_boundary(inward(mesh)) == mesh);
  }
  CHECK(solid_boundary(TriangleMesh{}).faces.empty());
}

TEST_CASE("An open mesh bounds no solid", "[geometry][solid_boundary]") {
  TriangleMesh mesh = box({1, 1, 1});
  mesh.faces.pop_back();
  CHECK_THROWS_WITH(solid_boundary(mesh), graspfit::testing::Contains("bounds no solid"));
  mesh = box({1, 1, 1});
  std::swap(mesh.faces[0][0], mesh.faces[0][1]);
  CHECK_THROWS_AS(solid_boundary(mesh), InvalidInput);
}

}  // namespace test_solid_boundary
