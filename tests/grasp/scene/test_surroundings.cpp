#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "contact/random_contacts.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/surroundings.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_surroundings {

using namespace graspfit;
using namespace graspfit::grasp;
using base::InvalidInput;
using base::Random;
using Eigen::Vector3d;
using geometry::MeshQuery;
using geometry::RigidTransform;
using geometry::TriangleMesh;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TriangleMesh at(TriangleMesh mesh, const Vector3d& place) {
  for (Vector3d& vertex : mesh.vertices) vertex += place;
  return mesh;
}

Surroundings with_table(double z) { return {z, {}}; }

RigidTransform random_pose(Random& random, double largest_shift) {
  RigidTransform X = RigidTransform::Identity();
  X.linear() =
      Eigen::AngleAxisd(random.uniform(0.0, std::numbers::pi), testing::random_direction(random))
          .toRotationMatrix();
  X.translation() = largest_shift * testing::random_direction(random);
  return X;
}

/// Returns a hand of one link, a box of 20 x 40 x 60 mm around the origin.
hands::HandModel block_hand() {
  hands::HandModel hand;
  hand.name = "block";
  hand.links.resize(1);
  hand.links[0].mesh_L = geometry::box({0.02, 0.04, 0.06});
  hand.palm.link = 0;
  return hand;
}

double lowest_vertex(const hands::Link& link, const RigidTransform& X_OL) {
  double lowest = kInfinity;
  for (const Vector3d& vertex : link.mesh_L.vertices) {
    lowest = std::min(lowest, (X_OL * vertex).z());
  }
  return lowest;
}

}  // namespace

TEST_CASE("A link touches the table exactly from its lowest vertex on", "[grasp][surroundings]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const hands::HandCollision collision(hand);
  // The link is moved without a turn, so that the order of heights survives rounding and the answer
  // may be tested at the very height and one digit below it.
  RigidTransform X = RigidTransform::Identity();
  X.translation() = Vector3d(0.3, -0.2, 0.1234567);
  for (int link = 0; link < static_cast<int>(hand.links.size()); ++link) {
    const double lowest = lowest_vertex(hand.links[static_cast<std::size_t>(link)], X);
    const SurroundingsCollision touching(hand, with_table(lowest));
    const SurroundingsCollision clear(hand, with_table(std::nextafter(lowest, -1.0)));
    CHECK(touching.touches(collision, link, X));
    CHECK(touching.distance(collision, link, X, 1.0).distance == 0.0);
    CHECK_FALSE(clear.touches(collision, link, X));
    CHECK(clear.distance(collision, link, X, 1.0).distance > 0.0);
  }
}

TEST_CASE("A table's clearance counts as the table", "[grasp][surroundings]") {
  const hands::HandModel hand = block_hand();
  const hands::HandCollision collision(hand);
  Surroundings with_clearance = with_table(-0.05);
  with_clearance.table_clearance = 0.02;
  const SurroundingsCollision surroundings(hand, with_clearance);
  RigidTransform X = RigidTransform::Identity();  // The block reaches down to -0.03.
  X.translation().z() = -1e-9;
  CHECK(surroundings.touches(collision, 0, X));
  X.translation().z() = -0.015;
  const auto below = surroundings.over_table(0, X, 0.0);
  REQUIRE(below);
  CHECK(below->height == Approx(-0.015));
  X.translation().z() = 0.004;
  CHECK_FALSE(surroundings.touches(collision, 0, X));
  CHECK(surroundings.distance(collision, 0, X, 0.01).distance == Approx(0.004));
  const auto over = surroundings.over_table(0, X, 0.01);
  REQUIRE(over);
  CHECK(over->height == Approx(0.004));
  CHECK(over->corner_O.z() == Approx(-0.026));
  CHECK_FALSE(surroundings.over_table(0, X, 0.003));
  CHECK_FALSE(SurroundingsCollision(hand, {}).over_table(0, X, 1.0));
  for (const double bad : {-1e-3, std::nan(""), kInfinity}) {
    with_clearance.table_clearance = bad;
    CHECK_THROWS_WITH(SurroundingsCollision(hand, with_clearance),
                      testing::Contains("table_clearance"));
  }
}

TEST_CASE("Hull corners answer for all vertices over a table", "[grasp][surroundings]") {
  const hands::HandModel hand = hands::find_hand("human_hand");
  const hands::HandCollision collision(hand);
  const double table = -0.01;
  const SurroundingsCollision surroundings(hand, with_table(table));
  Random random(3);
  int num_touching = 0;
  int num_beyond = 0;
  for (int i = 0; i < 40; ++i) {
    const RigidTransform X = random_pose(random, 0.06);
    for (int link = 0; link < static_cast<int>(hand.links.size()); ++link) {
      const double height = lowest_vertex(hand.links[static_cast<std::size_t>(link)], X) - table;
      const double enough = 0.02;
      const SurroundingsDistance found = surroundings.distance(collision, link, X, enough);
      num_touching += height <= 0.0;
      num_beyond += height > enough;
      CHECK(surroundings.touches(collision, link, X) == (height <= 0.0));
      if (height <= 0.0) {
        CHECK(found.distance == 0.0);
      } else if (height > enough) {
        CHECK(found.distance == kInfinity);
      } else {
        CHECK(found.distance == Approx(height).margin(1e-15));
        CHECK(found.point_on_link_O.z() == Approx(table + height).margin(1e-15));
        CHECK(found.normal_O == Vector3d::UnitZ());
      }
    }
  }
  CHECK(num_touching > 50);
  CHECK(num_beyond > 50);
}

TEST_CASE("Obstacles are as far as their surfaces and touched where solids meet",
          "[grasp][surroundings]") {
  const hands::HandModel hand = block_hand();
  const hands::HandCollision collision(hand);
  const RigidTransform X = RigidTransform::Identity();
  const auto distance = [&](const Surroundings& around, double enough) {
    return SurroundingsCollision(hand, around).distance(collision, 0, X, enough);
  };
  // A block at x from 0.013 on is 3 mm beside the link, which is to its left.
  const MeshQuery beside(at(geometry::box({0.1, 0.1, 0.1}), {0.063, 0.0, 0.0}));
  const SurroundingsDistance found = distance({{}, {beside}}, 0.01);
  CHECK(found.distance == Approx(0.003).epsilon(1e-12));
  CHECK(found.normal_O.isApprox(-Vector3d::UnitX(), 1e-12));
  CHECK(found.point_on_link_O.x() == Approx(0.01));
  CHECK(distance({{}, {beside}}, 0.0029).distance == kInfinity);
  // The nearest of all counts: a table 2 mm below does, one 4 mm below does not.
  const MeshQuery above(at(geometry::box({0.1, 0.1, 0.1}), {0.0, 0.0, 0.081}));
  CHECK(distance({{}, {beside, above}}, 0.01).normal_O.isApprox(-Vector3d::UnitZ(), 1e-12));
  CHECK(distance({{}, {above, beside}}, 0.01).distance == Approx(0.001).epsilon(1e-9));
  CHECK(distance({-0.032, {beside}}, 0.01).normal_O == Vector3d::UnitZ());
  CHECK(distance({-0.034, {beside}}, 0.01).distance == Approx(0.003).epsilon(1e-12));
  // A link inside an obstacle counts as inside, although they share no surface point.
  const MeshQuery around(geometry::box({1.0, 1.0, 1.0}));
  CHECK(distance({{}, {around}}, 0.01).distance == 0.0);
  CHECK(SurroundingsCollision(hand, {{}, {around}}).touches(collision, 0, X));
  // Faces that lie on each other touch.
  const MeshQuery flush(at(geometry::box({0.02, 0.1, 0.1}), {0.02, 0.0, 0.0}));
  CHECK(SurroundingsCollision(hand, {{}, {flush}}).touches(collision, 0, X));
  CHECK_FALSE(SurroundingsCollision(hand, {{}, {beside, above}}).touches(collision, 0, X));
}

TEST_CASE("Distance from obstacles is that of the meshes, zero where they intersect",
          "[grasp][surroundings]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const hands::HandCollision collision(hand);
  const MeshQuery obstacle(geometry::torus(0.05, 0.02, 24, 12));
  const SurroundingsCollision surroundings(hand, {{}, {obstacle}});
  Random random(8);
  int num_touching = 0;
  int num_between = 0;
  for (int i = 0; i < 40; ++i) {
    const RigidTransform X = random_pose(random, 0.1);
    const int link = static_cast<int>(random.index(hand.links.size()));
    const double expected = geometry::distance(obstacle, *collision.link_solid(link), X).distance;
    const double enough = 0.03;
    const SurroundingsDistance found = surroundings.distance(collision, link, X, enough);
    CHECK(found.distance == (expected <= enough ? expected : kInfinity));
    CHECK(surroundings.touches(collision, link, X) == (expected == 0.0));
    num_touching += expected == 0.0;
    if (expected <= 0.0 || expected > enough) continue;
    ++num_between;
    // The obstacle's surface lies back along the normal from the point on the link.
    const Vector3d foot = found.point_on_link_O - found.distance * found.normal_O;
    CHECK(std::abs(obstacle.signed_distance(foot)) < 1e-12);
  }
  CHECK(num_touching > 3);
  CHECK(num_between > 3);
}

TEST_CASE("Nothing around touches nothing; what makes no sense is refused",
          "[grasp][surroundings]") {
  const hands::HandModel hand = hands::find_hand("parallel_gripper");
  const hands::HandCollision collision(hand);
  const SurroundingsCollision none(hand, {});
  CHECK(none.surroundings().is_empty());
  CHECK_FALSE(none.touches(collision, 0, RigidTransform::Identity()));
  CHECK(none.distance(collision, 0, RigidTransform::Identity(), 1.0).distance == kInfinity);
  // A link without faces is nowhere.
  hands::HandModel empty = block_hand();
  empty.links[0].mesh_L = {};
  const SurroundingsCollision over_all(empty, with_table(10.0));
  CHECK_FALSE(over_all.touches(hands::HandCollision(empty), 0, RigidTransform::Identity()));

  for (const double z : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity}) {
    CHECK_THROWS_WITH(SurroundingsCollision(hand, with_table(z)), testing::Contains("table_z_O"));
  }
  TriangleMesh open = geometry::box({0.1, 0.1, 0.1});
  open.faces.pop_back();
  const MeshQuery closed(geometry::box({0.1, 0.1, 0.1}));
  CHECK_THROWS_WITH(SurroundingsCollision(hand, {{}, {closed, MeshQuery(open)}}),
                    testing::Contains("obstacle 1 is not closed (3 boundary edges"));
  CHECK_THROWS_AS(SurroundingsCollision(hand, {{}, {MeshQuery(open)}}), InvalidInput);
  for (const Surroundings& around : {with_table(0.0), Surroundings{{}, {closed}}}) {
    const SurroundingsCollision surroundings(hand, around);
    RigidTransform X = RigidTransform::Identity();
    X.translation().z() = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(surroundings.touches(collision, 0, X), InvalidInput);
    CHECK_THROWS_AS(surroundings.distance(collision, 0, X, 1.0), InvalidInput);
  }
}

}  // namespace test_surroundings
