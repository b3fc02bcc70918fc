#include <Eigen/Geometry>
#include <numbers>
#include <utility>

#include "graspfit/geometry/distance_map.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "graspfit/geometry/voxel_grid.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

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
  REQUIRE(found.link_a >= 0);
  REQUIRE(found.link_b >= 0);
  CHECK(found.link_a < found.link_b);
  CHECK(found.link_a == barrett().link_index("finger_1_distal_link"));
  CHECK(found.link_b == barrett().link_index("finger_2_distal_link"));
}

TEST_CASE("Self-collision does not depend on where the hand is", "[hands][hand_collision]") {
  geometry::Random random(11);
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
  // Uniform joint positions close the fingers on nothing: 14 of these 60 hands touch themselves.
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
       {0.01, 0.001, -0.001, -0.005}) {  // of the ball's lowest point over z = 0
    CAPTURE(height);
    hands::RigidTransform lift = hands::RigidTransform::Identity();
    lift.translation().z() = height - lowest;
    const geometry::MeshQuery object(geometry::transformed(ball, lift));
    const auto found = collision().against_object(object, X_OL);
    CHECK(found.intersects == (height < 0.0));
    CHECK(found.depth == Approx(std::max(-height, 0.0)).margin(2e-5));
    if (found.intersects) {
      CHECK(found.link_a == 0);
      CHECK(found.link_b == -1);
    }
  }
}

geometry::SignedDistanceMap distance_map_of(const geometry::MeshQuery& object, double margin) {
  const geometry::VoxelLattice lattice =
      geometry::lattice_around(object.box(), {.resolution = 30, .margin = margin});
  return geometry::signed_distance_map(
      geometry::voxelize(object, lattice, geometry::surface_patches(object.mesh(), lattice)));
}

TEST_CASE("What is surely clear of an object never intersects it, and most far enough away is",
          "[hands][hand_collision]") {
  struct Case {
    geometry::TriangleMesh mesh;
    double margin;  ///< Of the lattice: links leave it in the second case.
  };
  geometry::Random random(5);
  int num_clear = 0, num_far = 0, num_touching = 0;
  for (const Case& c : {Case{geometry::torus(0.05, 0.02, 48, 24), 0.15},
                        Case{geometry::box({0.15, 0.04, 0.08}), 0.01}}) {
    const geometry::MeshQuery object(c.mesh);
    const geometry::SignedDistanceMap map = distance_map_of(object, c.margin);
    const double voxel = map.lattice.voxel_size;
    for (int i = 0; i < 360; ++i) {
      const int link = i % static_cast<int>(barrett().links.size());
      Eigen::Vector4d q;
      for (double& x : q) x = random.uniform(-1.0, 1.0);
      hands::RigidTransform X(Eigen::Quaterniond(q).normalized());
      const Vector3d direction =
          Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))
              .normalized();
      const Vector3d middle = geometry::bounding_box(barrett().links[link].mesh_L).center();
      const auto intersects = [&](double way) {
        X.translation() = way * direction - X.linear() * middle;
        const bool is_clear = collision().surely_clear(map, link, X);
        const bool found = collision().link_intersects(object, link, X);
        CHECK_FALSE((is_clear && found));
        return found;
      };
      // Where it last touches on its way out, to the last bit; then off by more and more.
      double inside = 0.0, outside = 0.4;
      REQUIRE_FALSE(intersects(outside));
      for (double way = 0.4; way > 0.0 && !intersects(way); way -= 0.005) inside = way - 0.005;
      if (!intersects(inside)) continue;  // through the ring
      for (int step = 0; step < 60; ++step) {
        const double half = 0.5 * (inside + outside);
        (intersects(half) ? inside : outside) = half;
      }
      ++num_touching;
      for (const double off : {1e-9, 1e-6, 1e-4, 1e-3, 1e-2}) intersects(outside + off);
      // Off along the way by six voxels and the length of the link.
      const double length = geometry::bounding_box(barrett().links[link].mesh_L).diagonal().norm();
      if (intersects(outside + 6 * voxel + length)) continue;
      ++num_far;
      num_clear += collision().surely_clear(map, link, X) ? 1 : 0;
    }
  }
  CAPTURE(num_touching, num_far, num_clear);
  CHECK(num_touching > 500);
  CHECK(num_far > 500);
  CHECK(num_clear > 0.95 * num_far);
}

TEST_CASE("Nothing inside a link, or around one, is told to be clear of it",
          "[hands][hand_collision]") {
  const int palm = 0;
  const Vector3d middle = geometry::bounding_box(barrett().links[palm].mesh_L).center();
  hands::RigidTransform X = hands::RigidTransform::Identity();
  X.translation() = -middle;
  for (const auto& [radius, margin] :  // inside the palm; the palm inside it
       {std::pair{0.004, 0.01}, std::pair{0.3, 0.05}}) {
    const geometry::MeshQuery ball(geometry::ball(radius, 3));
    const geometry::SignedDistanceMap map = distance_map_of(ball, margin);
    REQUIRE(collision().link_intersects(ball, palm, X));
    CHECK_FALSE(collision().surely_clear(map, palm, X));
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

TEST_CASE("Links without faces and poses of another hand", "[hands][hand_collision]") {
  HandModel hand = barrett();
  for (hands::Link& link : hand.links) link.mesh_L = {};
  const HandCollision nothing(hand);
  const auto X_OL = hands::forward_kinematics(hand, configuration(pi / 2, 2.0, 2.0, 0));
  CHECK_FALSE(nothing.against_self(X_OL).intersects);
  CHECK_FALSE(nothing.against_object(geometry::MeshQuery(geometry::ball(1.0, 1)), X_OL).intersects);
  const geometry::MeshQuery ball(geometry::ball(0.1, 1));
  CHECK(nothing.surely_clear(distance_map_of(ball, 0.1), 0, X_OL[0]));
  CHECK_THROWS_AS(nothing.against_self({}), geometry::InvalidInput);
  CHECK_THROWS_AS(nothing.overlaps_self({}, 1e-3), geometry::InvalidInput);
}

}  // namespace
