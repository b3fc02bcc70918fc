#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_hand_collision {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using hands::HandCollision;
using hands::HandConfiguration;
using hands::HandModel;
using std::numbers::pi;

const HandModel& barrett() {
  static const HandModel hand = hands::find_hand("barrett");
  return hand;
}

const HandCollision& collision() {
  static const HandCollision result(barrett());
  return result;
}

HandConfiguration configuration(double spread, double finger_1, double finger_2, double thumb) {
  HandConfiguration result = hands::open_configuration(barrett());
  result.q[barrett().joint_index("finger_1_spread")] = spread;
  result.q[barrett().joint_index("finger_1_proximal")] = finger_1;
  result.q[barrett().joint_index("finger_2_proximal")] = finger_2;
  result.q[barrett().joint_index("thumb_proximal")] = thumb;
  hands::apply_couplings(barrett(), result.q);
  return result;
}

/// Closed far enough for links to overlap more often than not.
HandConfiguration random_configuration(base::Random& random) {
  const double spread = random.uniform(0, pi);
  const double finger_1 = random.uniform(1.2, 2.4);
  const double finger_2 = random.uniform(1.2, 2.4);
  return configuration(spread, finger_1, finger_2, random.uniform(1.2, 2.4));
}

HandCollision::Result self(const HandConfiguration& c) {
  return collision().against_self(hands::forward_kinematics(barrett(), c));
}

TEST_CASE("The open Barrett hand does not touch itself at any spread", "[hands][hand_collision]") {
  for (int k = 0; k <= 18; ++k) {
    const auto found = self(configuration(k * pi / 18, 0, 0, 0));
    CAPTURE(k, found.link_a, found.link_b, found.depth);
    CHECK_FALSE(found.intersects);
    CHECK(found.depth == 0.0);
  }
}

TEST_CASE("Half closed, the Barrett hand does not touch itself at any spread",
          "[hands][hand_collision]") {
  for (int k = 0; k <= 18; ++k) {
    const auto found = self(configuration(k * pi / 18, 0.8, 0.8, 0.8));
    CAPTURE(k, found.link_a, found.link_b, found.depth);
    CHECK_FALSE(found.intersects);
  }
}

TEST_CASE("Fingers closed on nothing meet each other, and both links are named",
          "[hands][hand_collision]") {
  // At a spread of 90 degrees fingers 1 and 2 oppose each other, with bases 50 mm apart: their tip
  // points meet at 108 degrees. (At spread 0 they pass the thumb on both sides.)
  const auto found = self(configuration(pi / 2, 2.0, 2.0, 0));
  CHECK(found.intersects);
  CHECK(found.depth > 0.0);
  CHECK(found.depth <= found.depth_bound);
  REQUIRE(found.link_a);
  REQUIRE(found.link_b);
  CHECK(found.link_a < found.link_b);
  CHECK(found.link_a == barrett().link_index("finger_1_distal_link"));
  CHECK(found.link_b == barrett().link_index("finger_2_distal_link"));
}

TEST_CASE("Self-collision does not depend on where the hand is", "[hands][hand_collision]") {
  base::Random random(11);
  int collides = 0;
  constexpr int kCount = 60;
  for (int k = 0; k < kCount; ++k) {
    HandConfiguration c =
        configuration(random.uniform(0, pi), random.uniform(0, 140.0 / 180 * pi),
                      random.uniform(0, 140.0 / 180 * pi), random.uniform(0, 140.0 / 180 * pi));
    const auto here = self(c);
    c.X_OH.linear() = Eigen::AngleAxisd(random.uniform(-3, 3), Vector3d(1, -1, 2).normalized())
                          .toRotationMatrix();
    c.X_OH.translation() = Vector3d(0.3, -0.1, 0.2);
    const auto there = self(c);
    CHECK(here.intersects == there.intersects);
    // Depths are found to 1e-5 m.
    CHECK(here.depth == Approx(there.depth).margin(2e-5));
    collides += here.intersects ? 1 : 0;
  }
  // Uniform joint positions close the fingers on nothing, and 14 of these 60 hands touch
  // themselves.
  CHECK(collides > 0);
  CHECK(collides < kCount / 2);
}

TEST_CASE("A ball is hit exactly when it reaches the palm, and the depth is how far",
          "[hands][hand_collision]") {
  const auto X_OL = hands::forward_kinematics(barrett(), hands::open_configuration(barrett()));
  const double radius = 0.03;
  const geometry::TriangleMesh ball = geometry::ball(radius, 3);
  double lowest = 0.0;
  for (const Vector3d& v : ball.vertices) lowest = std::min(lowest, v.z());
  for (const double height :
       {0.01, 0.001, -0.001, -0.005}) {  // These are heights of the ball's lowest point over z = 0.
    CAPTURE(height);
    hands::RigidTransform lift = hands::RigidTransform::Identity();
    lift.translation().z() = height - lowest;
    const geometry::MeshQuery object(geometry::transformed(ball, lift));
    const auto found = collision().against_object(object, X_OL);
    CHECK(found.intersects == (height < 0.0));
    CHECK(found.depth == Approx(std::max(-height, 0.0)).margin(2e-5));
    if (found.intersects) {
      CHECK(found.link_a == 0);
      CHECK_FALSE(found.link_b);
    }
  }
}

TEST_CASE("Links overlap by more than what their depth says, and by no less",
          "[hands][hand_collision]") {
  const auto X_OL = hands::forward_kinematics(barrett(), configuration(pi / 2, 2.0, 2.0, 0));
  const HandCollision::Result found = collision().against_self(X_OL);
  REQUIRE(found.depth > 1e-3);
  CHECK(collision().overlaps_self(X_OL, 1e-5));
  CHECK(collision().overlaps_self(X_OL, 0.4 * found.depth));
  CHECK_FALSE(collision().overlaps_self(X_OL, 1.01 * found.depth_bound));
  const auto X_open = hands::forward_kinematics(barrett(), configuration(0, 0, 0, 0));
  CHECK_FALSE(collision().overlaps_self(X_open, 1e-9));
}

TEST_CASE("The pairs that overlap are those that, left out one after the other, leave nothing",
          "[hands][hand_collision]") {
  base::Random random(3);
  int num_several = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const auto X_OL = hands::forward_kinematics(barrett(), random_configuration(random));
    HandModel hand = barrett();
    std::vector<std::pair<int, int>> deepest_first;
    while (true) {
      const HandCollision::Result found = HandCollision(hand).against_self(X_OL);
      if (!found.intersects) break;
      deepest_first.emplace_back(*found.link_a, *found.link_b);
      hand.exclusions.push_back({*found.link_a, *found.link_b});
    }
    num_several += deepest_first.size() > 1;
    std::sort(deepest_first.begin(), deepest_first.end());
    CHECK(collision().overlapping_pairs(X_OL) == deepest_first);
    CHECK(HandCollision(hand).overlapping_pairs(X_OL).empty());
  }
  CHECK(num_several > 3);
}

TEST_CASE("A pair of links that is likely to overlap changes no verdict",
          "[hands][hand_collision]") {
  base::Random random(5);
  int num_deep = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const auto X_OL = hands::forward_kinematics(barrett(), random_configuration(random));
    const double depth = 1e-4;
    const auto first = collision().pair_deeper_than(X_OL, depth);
    std::vector<std::pair<int, int>> deep;
    for (const auto& pair : collision().overlapping_pairs(X_OL)) {
      const auto [a, b] = pair;
      const geometry::Penetration found = geometry::penetration(
          *collision().link_solid(a), *collision().link_solid(b), X_OL[a].inverse() * X_OL[b]);
      if (std::abs(found.depth - depth) < 0.6 * depth) continue;
      if (found.depth > depth) {
        deep.push_back(pair);
        CHECK(collision().pair_deeper_than(X_OL, depth, pair) == pair);
      } else {
        CHECK(collision().pair_deeper_than(X_OL, depth, pair) == first);
      }
    }
    num_deep += deep.size() > 1;
    if (!deep.empty()) REQUIRE(first);
    CHECK(collision().overlaps_self(X_OL, depth) == first.has_value());
    CHECK(collision().pair_deeper_than(X_OL, depth, std::pair(0, 1)).has_value() ==
          first.has_value());
  }
  CHECK(num_deep > 5);
}

TEST_CASE("Links without faces and poses of another hand", "[hands][hand_collision]") {
  HandModel hand = barrett();
  for (hands::Link& link : hand.links) link.mesh_L = {};
  const HandCollision nothing(hand);
  const auto X_OL = hands::forward_kinematics(hand, configuration(pi / 2, 2.0, 2.0, 0));
  CHECK_FALSE(nothing.against_self(X_OL).intersects);
  CHECK_FALSE(nothing.against_object(geometry::MeshQuery(geometry::ball(1.0, 1)), X_OL).intersects);
  CHECK_THROWS_AS(nothing.against_self({}), base::InvalidInput);
  CHECK(nothing.overlapping_pairs(X_OL).empty());
  CHECK_THROWS_AS(nothing.overlaps_self({}, 1e-3), base::InvalidInput);
  CHECK_THROWS_AS(nothing.overlapping_pairs({}), base::InvalidInput);
}

TEST_CASE("Poses that are not finite are refused, wherever the links are",
          "[hands][hand_collision]") {
  const geometry::MeshQuery object(geometry::box({0.05, 0.05, 0.05}));
  const auto open = hands::forward_kinematics(barrett(), hands::open_configuration(barrett()));
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (const auto& [row, column] : {std::pair{0, 0}, {2, 3}}) {
      auto X_OL = open;
      X_OL[1](row, column) = bad;
      CHECK_THROWS_AS(collision().link_intersects(object, 1, X_OL[1]), base::InvalidInput);
      CHECK_THROWS_AS(collision().link_depth_above(object, 1, X_OL[1], 0.0, {}),
                      base::InvalidInput);
      CHECK_THROWS_AS(collision().against_object(object, X_OL), base::InvalidInput);
      CHECK_THROWS_AS(collision().against_self(X_OL), base::InvalidInput);
      CHECK_THROWS_AS(collision().overlapping_pairs(X_OL), base::InvalidInput);
      CHECK_THROWS_AS(collision().overlaps_self(X_OL, 1e-3), base::InvalidInput);
    }
    HandConfiguration configuration = hands::open_configuration(barrett());
    configuration.q[2] = bad;
    CHECK_THROWS_AS(hands::forward_kinematics(barrett(), configuration), base::InvalidInput);
    configuration = hands::open_configuration(barrett());
    configuration.X_OH.translation().z() = bad;
    CHECK_THROWS_AS(hands::forward_kinematics(barrett(), configuration), base::InvalidInput);
  }
}

}  // namespace

}  // namespace test_hand_collision
