#include <Eigen/Geometry>
#include <limits>

#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/surface_proximity.hpp"
#include "support/catch.hpp"

namespace test_surface_proximity {

using namespace graspfit::base;
using namespace graspfit::geometry;

namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

RigidTransform drawn_pose(Random& random, double size) {
  Eigen::Vector4d q;
  for (double& x : q) x = random.uniform(-1.0, 1.0);
  RigidTransform X(Eigen::Quaterniond(q).normalized());
  for (double& x : X.translation()) x = random.uniform(-size, size);
  return X;
}

}  // namespace

TEST_CASE("Nearest points agree with the distance of solids that are apart",
          "[geometry][surface_proximity]") {
  const MeshQuery a(torus(1.0, 0.3, 24, 12));
  const MeshQuery b(box({0.5, 0.2, 0.9}));
  Random random(5);
  int num_apart = 0;
  int num_crossing = 0;
  for (int i = 0; i < 200; ++i) {
    const RigidTransform X_AB = drawn_pose(random, 1.6);
    const auto nearest = nearest_points(a, b, X_AB, kNoLimit);
    REQUIRE(nearest);
    if (do_intersect(a, b, X_AB)) {
      ++num_crossing;
      // Neither is small enough to be inside the other.
      CHECK(nearest->distance == 0.0);
      continue;
    }
    ++num_apart;
    // These are two constructions of the same length; coordinates of about 2 are rounded some ten
    // times.
    CHECK(nearest->distance == Approx(distance(a, b, X_AB).distance).margin(1e-14));
    CHECK((nearest->point_on_a_A - nearest->point_on_b_A).norm() ==
          Approx(nearest->distance).margin(1e-15));
    CHECK(a.closest_point(nearest->point_on_a_A).squared_distance < 1e-28);
    CHECK(b.closest_point(X_AB.inverse() * nearest->point_on_b_A).squared_distance < 1e-28);
    // A seed, even a bad one, changes nothing.
    const auto seeded = nearest_points(a, b, X_AB, kNoLimit, {i % 100, i % 12});
    REQUIRE(seeded);
    CHECK(seeded->distance == Approx(nearest->distance).margin(1e-15));
    // Any pair within a limit is allowed, but there must be one exactly where there is a nearer
    // one.
    const auto any = nearest_points(a, b, X_AB, kNoLimit, {}, 1.5 * nearest->distance);
    REQUIRE(any);
    CHECK(any->distance <= 1.5 * nearest->distance);
    CHECK(any->distance >= nearest->distance - 1e-15);
    CHECK_FALSE(nearest_points(a, b, X_AB, 0.999 * nearest->distance));
    CHECK(nearest_points(a, b, X_AB, 1.001 * nearest->distance + 1e-12));
  }
  CHECK(num_apart > 50);
  CHECK(num_crossing > 40);
}

TEST_CASE("A pose written with three digits gives the distance of the mesh moved by it",
          "[geometry][surface_proximity]") {
  // The inverse of such a matrix is not its transpose: boxes seen along its columns are off by a
  // thousandth, more than the distances of many pairs of faces differ.
  const MeshQuery a(ball(1.0, 3));
  const TriangleMesh other = torus(1.0, 0.3, 48, 24);
  const MeshQuery b(other);
  Random random(12);
  int num_apart = 0;
  for (int i = 0; i < 200; ++i) {
    RigidTransform X_AB = drawn_pose(random, 3.0);
    X_AB.linear() = (X_AB.linear().array() * 1e3).round() / 1e3;
    const MeshQuery moved(transformed(other, X_AB));
    const RigidTransform at = RigidTransform::Identity();
    const auto nearest = nearest_points(a, b, X_AB, kNoLimit);
    const auto expected = nearest_points(a, moved, at, kNoLimit);
    REQUIRE((nearest && expected));
    num_apart += expected->distance > 0.0 ? 1 : 0;
    INFO("pose " << i);
    CHECK(nearest->distance == Approx(expected->distance).margin(1e-14));
    const double clearance = surface_clearance(a, b, X_AB, kNoLimit, 1.0).at_least;
    CHECK(clearance <= expected->distance + 1e-12);
    CHECK(clearance >= expected->distance - 1e-12);
  }
  CHECK(num_apart > 100);
}

TEST_CASE("A surface inside another has a distance from it", "[geometry][surface_proximity]") {
  const MeshQuery outer(box({2, 2, 2}));
  const MeshQuery inner(box({1, 1, 1}));
  RigidTransform X = RigidTransform::Identity();
  X.translation() = Eigen::Vector3d(0.25, 0, 0);
  const auto nearest = nearest_points(outer, inner, X, kNoLimit);
  REQUIRE(nearest);
  CHECK(nearest->distance == Approx(0.25).margin(1e-15));  // It is 1 − (0.5 + 0.25).
}

TEST_CASE("An open surface pierced in its middle is at distance zero",
          "[geometry][surface_proximity]") {
  TriangleMesh sheet;
  sheet.vertices = {{-9, -9, 0.01}, {9, -9, 0.01}, {0, 9, 0.01}};
  sheet.faces = {{0, 1, 2}};
  const MeshQuery needle(box({0.1, 0.1, 2}));
  const auto nearest =
      nearest_points(MeshQuery(sheet), needle, RigidTransform::Identity(), kNoLimit);
  REQUIRE(nearest);
  CHECK(nearest->distance == 0.0);
  CHECK(nearest->face_a == 0);
}

}  // namespace test_surface_proximity
