#include <cmath>

#include "geometry/changed_meshes.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/surface_distance.hpp"
#include "support/catch.hpp"

namespace test_surface_distance {

using namespace graspfit::base;
using namespace graspfit::geometry;
using graspfit::testing::moved;

namespace {

/// Returns every face cut in four, with the surface unchanged.
TriangleMesh finer(const TriangleMesh& mesh) {
  TriangleMesh result;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const auto [a, b, c] = corners(mesh, face);
    const auto i = static_cast<std::int32_t>(result.vertices.size());
    result.vertices.insert(result.vertices.end(),
                           {a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)});
    for (const Face& f : {Face{0, 3, 5}, Face{3, 1, 4}, Face{5, 4, 2}, Face{3, 4, 5}}) {
      result.faces.push_back({i + f[0], i + f[1], i + f[2]});
    }
  }
  return result;
}

}  // namespace

TEST_CASE("Surfaces of known distance have it between the bounds, either way around",
          "[geometry][surface_distance]") {
  const TriangleMesh cube = box({1, 1, 1});
  struct Case {
    TriangleMesh a;
    TriangleMesh b;
    double distance;
  };
  const std::vector<Case> cases = {
      {cube, cube, 0.0},
      {cube, finer(finer(cube)), 0.0},
      // A side moves by as much as the box.
      {cube, moved(cube, {0.25, 0, 0}), 0.25},
      {cube, finer(moved(cube, {0.25, 0, 0})), 0.25},
      // The distance is from corner to corner.
      {cube, box({2, 2, 2}), 0.5 * std::sqrt(3.0)},
      // The distance is from the far side of one to the near side of the other.
      {cube, moved(cube, {5, 0, 0}), 5.0},
      // A vertex on twice the sphere is nearest to the vertex below it, which is the farthest out.
      {ball(1, 2), ball(2, 2), 1.0},
      {ball(1, 3), ball(2, 2), 1.0}};
  for (const auto& [a, b, exact] : cases) {
    for (const bool is_swapped : {false, true}) {
      const MeshQuery first(is_swapped ? b : a);
      const MeshQuery second(is_swapped ? a : b);
      const HausdorffDistance found = hausdorff_distance(first, second, {.tolerance = 1e-6});
      CHECK(found.lower <= exact + 1e-14);
      CHECK(found.upper >= exact);
      CHECK(found.upper - found.lower < 1.1e-6);
      CHECK((found.point_on_a - found.point_on_b).norm() == Approx(found.lower).margin(1e-15));
      CHECK(first.closest_point(found.point_on_a).squared_distance < 1e-28);
      CHECK(second.closest_point(found.point_on_b).squared_distance < 1e-28);
    }
  }
}

TEST_CASE("Stopped early the bounds are wide and hold", "[geometry][surface_distance]") {
  const MeshQuery a(torus(1, 0.3, 24, 12));
  const MeshQuery b(ball(0.9, 2));
  const HausdorffDistance fine = hausdorff_distance(a, b, {.tolerance = 1e-6});
  double last = std::numeric_limits<double>::infinity();
  for (const int max_steps : {0, 10, 100, 1000}) {
    const HausdorffDistance coarse =
        hausdorff_distance(a, b, {.tolerance = 1e-6, .max_steps = max_steps});
    CHECK(coarse.lower <= fine.upper);
    CHECK(coarse.upper >= fine.lower);
    CHECK(coarse.upper <= last);
    last = coarse.upper;
  }
  // No sample of either surface is farther than the bound.
  Random random(5);
  for (int i = 0; i < 2000; ++i) {
    const MeshQuery& from = i % 2 == 0 ? a : b;
    const auto [p, q, r] = corners(from.mesh(), random.index(from.mesh().faces.size()));
    const double s = random.uniform();
    const double t = random.uniform() * (1.0 - s);
    const Eigen::Vector3d point = p + s * (q - p) + t * (r - p);
    const double distance = std::sqrt((i % 2 == 0 ? b : a).closest_point(point).squared_distance);
    REQUIRE(distance <= fine.upper);
  }
}

TEST_CASE("Bad options of the Hausdorff distance are refused", "[geometry][surface_distance]") {
  const MeshQuery cube(box({1, 1, 1}));
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    CHECK_THROWS_AS(hausdorff_distance(cube, cube, {.tolerance = bad}), InvalidInput);
  }
  CHECK_THROWS_AS(hausdorff_distance(cube, cube, {.max_steps = -1}), InvalidInput);
}

}  // namespace test_surface_distance
