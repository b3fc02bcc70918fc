#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "contact/random_contacts.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/grasp/distinct_grasps.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_distinct_grasps {

using namespace graspfit;
using namespace graspfit::grasp;
using base::InvalidInput;
using base::Random;
using Eigen::AngleAxisd;
using Eigen::Vector3d;
using geometry::RigidTransform;
using hands::HandConfiguration;

namespace {

RigidTransform random_pose(Random& random) {
  RigidTransform X = RigidTransform::Identity();
  X.linear() = AngleAxisd(random.uniform(0.0, std::numbers::pi), testing::random_direction(random))
                   .toRotationMatrix();
  X.translation() = 0.1 * testing::random_direction(random);
  return X;
}

HandConfiguration moved_along_x(HandConfiguration configuration, double distance) {
  configuration.X_OH.translation().x() += distance;
  return configuration;
}

}  // namespace

TEST_CASE("Grasps are as far apart as their palm centers, palms and joints are",
          "[grasp][distinct_grasps]") {
  hands::HandModel hand = hands::find_hand("barrett");
  hand.palm.center_H = {0.0, 0.0, 0.05};
  const HandConfiguration a = hands::open_configuration(hand);
  HandConfiguration b = a;
  // The turn is about x through the frame's origin: the palm center moves along the chord 2 r
  // sin(angle / 2).
  b.X_OH.linear() = AngleAxisd(0.3, Vector3d::UnitX()).toRotationMatrix();
  b.q[hand.joint_index("thumb_proximal")] += 0.25;
  b.q[hand.joint_index("finger_1_spread")] += 0.15;
  b.q[hand.joint_index("thumb_distal")] += 0.4;  // This joint is coupled and does not count.
  const ConfigurationDistance found = configuration_distance(hand, a, b, 0.1);
  CHECK(found.translation == Approx(0.1 * std::sin(0.15)).epsilon(1e-12));
  CHECK(found.rotation == Approx(0.3).epsilon(1e-12));
  CHECK(found.joints == Approx(0.25).epsilon(1e-12));

  // Tiny turns keep their digits, and half a turn is the most.
  b.X_OH.linear() = AngleAxisd(1e-9, Vector3d::UnitY()).toRotationMatrix();
  CHECK(configuration_distance(hand, a, b, 0.1).rotation == Approx(1e-9).epsilon(1e-6));
  b.X_OH.linear() = AngleAxisd(1.5 * std::numbers::pi, Vector3d::UnitZ()).toRotationMatrix();
  CHECK(configuration_distance(hand, a, b, 0.1).rotation == Approx(0.5 * std::numbers::pi));

  // A slide counts in units of its scale.
  const hands::HandModel gripper = hands::find_hand("parallel_gripper");
  HandConfiguration wide = hands::open_configuration(gripper);
  const HandConfiguration narrow{wide.X_OH, wide.q.array() - 0.012};
  CHECK(configuration_distance(gripper, wide, narrow, 0.1).joints == Approx(0.12));
}

TEST_CASE("Any one of the three distances makes grasps distinct, equality does not",
          "[grasp][distinct_grasps]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const HandConfiguration a = hands::open_configuration(hand);
  const DistinctOptions options{.translation = 0.25, .rotation = 0.5, .joints = 0.5};
  CHECK_FALSE(are_distinct(hand, a, a, {.translation = 0.0, .rotation = 0.0, .joints = 0.0}));
  CHECK_FALSE(are_distinct(hand, a, moved_along_x(a, 0.25), options));
  CHECK(are_distinct(hand, a, moved_along_x(a, std::nextafter(0.25, 1.0)), options));
  for (const double share : {0.99, 1.01}) {
    HandConfiguration turned = a;
    turned.X_OH.linear() = AngleAxisd(0.5 * share, Vector3d(0.6, 0.0, 0.8)).toRotationMatrix();
    CHECK(are_distinct(hand, a, turned, options) == (share > 1.0));
    HandConfiguration closed = a;
    closed.q[hand.joint_index("finger_2_proximal")] += 0.5 * share;
    CHECK(are_distinct(hand, a, closed, options) == (share > 1.0));
  }
}

TEST_CASE("The distance of grasps is symmetric and does not change when both are moved",
          "[grasp][distinct_grasps]") {
  Random random(5);
  for (const char* name : {"barrett", "human_hand", "parallel_gripper"}) {
    const hands::HandModel hand = hands::find_hand(name);
    for (int i = 0; i < 20; ++i) {
      HandConfiguration a = hands::open_configuration(hand);
      HandConfiguration b = a;
      a.X_OH = random_pose(random);
      b.X_OH = random_pose(random);
      for (double& q : b.q) q += random.uniform(-0.5, 0.5);
      const RigidTransform X = random_pose(random);
      const ConfigurationDistance d = configuration_distance(hand, a, b, 0.1);
      const ConfigurationDistance swapped = configuration_distance(hand, b, a, 0.1);
      const ConfigurationDistance moved =
          configuration_distance(hand, {X * a.X_OH, a.q}, {X * b.X_OH, b.q}, 0.1);
      CHECK(swapped.translation == d.translation);
      CHECK(swapped.rotation == Approx(d.rotation).epsilon(1e-12));
      CHECK(swapped.joints == d.joints);
      CHECK(moved.translation == Approx(d.translation).margin(1e-14));
      CHECK(moved.rotation == Approx(d.rotation).margin(1e-12));
      CHECK(moved.joints == d.joints);
      CHECK(d.rotation <= std::numbers::pi);
    }
  }
}

TEST_CASE("A distinct subset keeps the best and leaves out only what is like a better one",
          "[grasp][distinct_grasps]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const HandConfiguration start = hands::open_configuration(hand);
  // They are 6 mm apart at a limit of 10 mm: neighbors are alike, the next but one is not.
  std::vector<HandConfiguration> chain;
  for (int i = 0; i < 6; ++i) chain.push_back(moved_along_x(start, 0.006 * i));
  CHECK(distinct_subset(hand, chain) == std::vector<std::size_t>{0, 2, 4});
  CHECK(distinct_subset(hand, {}).empty());
  CHECK(distinct_subset(hand, std::vector(3, start)) == std::vector<std::size_t>{0});

  Random random(17);
  std::vector<HandConfiguration> many;
  for (int i = 0; i < 200; ++i) {
    many.push_back(start);
    for (double& x : many.back().X_OH.translation()) x = random.uniform(-0.02, 0.02);
  }
  const std::vector<std::size_t> kept = distinct_subset(hand, many);
  CHECK(kept.size() > 5);
  CHECK(kept.size() < 195);
  std::size_t next = 0;
  for (std::size_t i = 0; i < many.size(); ++i) {
    bool is_like_a_better_one = false;
    for (std::size_t k = 0; k < next; ++k) {
      is_like_a_better_one |= !are_distinct(hand, many[kept[k]], many[i]);
    }
    const bool is_kept = next < kept.size() && kept[next] == i;
    CHECK(is_kept != is_like_a_better_one);
    next += is_kept ? 1 : 0;
  }
}

TEST_CASE("Distinctness refuses what makes no sense", "[grasp][distinct_grasps]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const HandConfiguration a = hands::open_configuration(hand);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const DistinctOptions& bad :
       {DistinctOptions{.translation = -1e-3}, DistinctOptions{.rotation = nan},
        DistinctOptions{.joints = -1.0}, DistinctOptions{.slide_scale = 0.0}}) {
    CHECK_THROWS_AS(are_distinct(hand, a, a, bad), InvalidInput);
    CHECK_THROWS_AS(distinct_subset(hand, {}, bad), InvalidInput);
  }
  HandConfiguration short_one = a;
  short_one.q.conservativeResize(2);
  CHECK_THROWS_WITH(are_distinct(hand, a, short_one),
                    testing::Contains("2") && testing::Contains("8"));
}

}  // namespace test_distinct_grasps
