#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "contact/random_contacts.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/grasp/pre_grasp.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "motion/table_scenes.hpp"
#include "support/catch.hpp"

namespace test_table_motion {

using namespace graspfit;
using namespace graspfit::motion;
using namespace graspfit::grasp;
using Eigen::Vector3d;
using geometry::RigidTransform;
using hands::HandConfiguration;
using testing::at;

namespace {

constexpr int kBlock = 0;
constexpr int kWall = 1;

/// The parallel gripper holds a block (40 x 20 x 30 mm) from above, its pads `gap` beside it; a
/// wall stands somewhere.
struct HeldBlock {
  explicit HeldBlock(const Vector3d& wall_size, double gap = 2e-5)
      : scene(hands::find_hand("parallel_gripper"),
              {testing::scene_object("block", geometry::box({0.04, 0.02, 0.03})),
               testing::scene_object("wall", geometry::box(wall_size))}) {
    hold = hands::open_configuration(scene.hand());
    hold.q.setConstant(0.02 + gap);
    // The palm direction is down. The middle between the pads, 62 mm from the palm frame, is 12 mm
    // over the block's center, so that the jaws end above its lower face.
    hold.X_OH.linear() = Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitX()).toRotationMatrix();
    hold.X_OH.translation().z() = 0.074;
  }

  HandConfiguration holding(const RigidTransform& X_WO) const { return {X_WO * hold.X_OH, hold.q}; }

  MotionSegment carry(MotionPhase phase, const RigidTransform& from,
                      const RigidTransform& to) const {
    return {phase, kBlock, holding(from), holding(to), from, to};
  }

  TableScene scene;
  HandConfiguration hold;  ///< In the block's frame.
};

}  // namespace

TEST_CASE("A block that is carried past a wall keeps the known distance and no more",
          "[grasp][table_motion]") {
  // The wall's top is below the jaws and above the block's lower face, so that the block is
  // nearest. The gap is 7 mm along y.
  const HeldBlock held({0.2, 0.02, 0.01});
  const double gap = 0.007;
  const std::vector<RigidTransform> X_WO = {at({0, 0, 0}), at({0.0, 0.02 + gap, 0.187})};
  const MotionSegment past =
      held.carry(MotionPhase::Transport, at({-0.3, 0, 0.2}), at({0.3, 0, 0.2}));
  for (const double share : {0.3, 0.5, 0.61}) {
    CHECK(clearance_at(held.scene, X_WO, past, share).object == Approx(gap).epsilon(1e-9));
  }
  CHECK_FALSE(find_collision(held.scene, X_WO, past, 0.0));
  double nearest = gap;
  for (int i = 0; i <= 600; ++i) {
    nearest = std::min(nearest, clearance_at(held.scene, X_WO, past, i / 600.0).hand);
  }
  CHECK(nearest == Approx(0.0045).epsilon(1e-6));  // The jaws are 2.5 mm wider than the block.
  // A proof is given up after 500 distances, so that it needs some margin on a long way.
  CHECK_FALSE(find_collision(held.scene, X_WO, past, nearest - 0.003));
  const auto met = find_collision(held.scene, X_WO, past, gap + 1e-6);
  REQUIRE(met);
  CHECK(met->second == "wall");
}

TEST_CASE("A motion through a wall thinner than any step is refused", "[grasp][table_motion]") {
  const HeldBlock held({0.5, 1e-4, 0.5});
  const std::vector<RigidTransform> X_WO = {at({0, 0, 0}), at({0, 0, 0.3})};
  const MotionSegment through =
      held.carry(MotionPhase::Transport, at({0, -0.2, 0.3}), at({0, 0.2, 0.3}));
  CHECK_FALSE(find_overlap(held.scene, X_WO, through, 0.0));
  CHECK_FALSE(find_overlap(held.scene, X_WO, through, 1.0));
  CHECK(find_collision(held.scene, X_WO, through, 0.0));
  // The empty hand does not pass either.
  MotionSegment empty = through;
  empty.phase = MotionPhase::Reach;
  empty.object = kBlock;
  empty.X_WO_from = empty.X_WO_to = at({0.8, 0, 0.02});
  CHECK(find_collision(held.scene, X_WO, empty, 0.0));
}

TEST_CASE("A turn is refused whose corner passes into a wall", "[grasp][table_motion]") {
  // Half the block's diagonal in x and y is 22.4 mm. As it turns by a right angle about z, its
  // corner passes at that distance, which the ends (20 and 10 mm) do not show.
  const HeldBlock held({0.01, 0.3, 0.01});
  const RigidTransform from = at({0, 0, 0.2}, -0.25 * std::numbers::pi);
  const RigidTransform to = at({0, 0, 0.2}, 0.5 * std::numbers::pi - 0.1);
  const MotionSegment turn = held.carry(MotionPhase::Transport, from, to);
  const auto wall_at = [](double distance) {
    return std::vector<RigidTransform>{at({0, 0, 0}), at({distance + 0.005, 0, 0.187})};
  };
  const double corner = std::hypot(0.02, 0.01);
  CHECK(find_collision(held.scene, wall_at(corner - 1e-5), turn, 0.0));
  MotionClearance nearest{1.0, 1.0};
  for (int i = 0; i <= 2000; ++i) {
    const MotionClearance here = clearance_at(held.scene, wall_at(0.05), turn, i / 2000.0);
    nearest.object = std::min(nearest.object, here.object);
  }
  CHECK(nearest.object == Approx(0.05 - corner).margin(1e-7));
}

TEST_CASE("An object rests where it is lifted and placed, and nowhere else",
          "[grasp][table_motion]") {
  const HeldBlock held({0.01, 0.01, 0.01});
  const std::vector<RigidTransform> X_WO = {at({0, 0, 0}), at({1, 1, 1})};
  const RigidTransform down = at({0, 0, 0.015});
  const RigidTransform up = at({0, 0, 0.1});
  CHECK_FALSE(find_collision(held.scene, X_WO, held.carry(MotionPhase::Lift, down, up), 0.0));
  CHECK_FALSE(find_collision(held.scene, X_WO, held.carry(MotionPhase::Place, up, down), 0.0));
  const auto dragged =
      find_collision(held.scene, X_WO, held.carry(MotionPhase::Transport, down, up), 0.0);
  REQUIRE(dragged);
  CHECK(dragged->text() == "block and table");
  // This goes into the table by more than rounding.
  const RigidTransform below = at({0, 0, 0.015 - 2e-9});
  CHECK(find_collision(held.scene, X_WO, held.carry(MotionPhase::Place, up, below), 0.0));
}

TEST_CASE("An approach may touch what it approaches, a reach may not", "[grasp][table_motion]") {
  const HeldBlock held({0.01, 0.01, 0.01}, 2e-6);
  const RigidTransform X_WB = at({0, 0, 0.015});
  const std::vector<RigidTransform> X_WO = {X_WB, at({1, 1, 1})};
  HandConfiguration open = held.holding(X_WB);
  open.q.setConstant(0.035);
  MotionSegment approach{MotionPhase::Approach, kBlock, open, held.holding(X_WB), X_WB, X_WB};
  CHECK_FALSE(find_collision(held.scene, X_WO, approach, 0.0));
  MotionSegment release = approach;
  release.phase = MotionPhase::Release;
  std::swap(release.from, release.to);
  CHECK_FALSE(find_collision(held.scene, X_WO, release, 0.0));
  approach.phase = MotionPhase::Reach;
  CHECK(find_collision(held.scene, X_WO, approach, 0.001));
  // Two millimeters into the block is no touch.
  approach.phase = MotionPhase::Approach;
  approach.to.q.setConstant(0.018);
  CHECK(find_collision(held.scene, X_WO, approach, 0.0));
}

TEST_CASE("A hand that stays where it is keeps its distance, or does not",
          "[grasp][table_motion]") {
  // A wall 50 mm thick stands far away in x, and the block elsewhere.
  const HeldBlock held({0.05, 0.4, 0.4});
  std::vector<RigidTransform> X_WO = {at({2, 2, 0.015}), at({1, 0, 0.2})};
  HandConfiguration hand = held.holding(at({0, 0, 0.5}));
  const auto resting = [&] {
    return MotionSegment{MotionPhase::Reach, kBlock, hand, hand, X_WO[kBlock], X_WO[kBlock]};
  };
  CHECK(largest_travel(held.scene, resting()) < 1e-15);
  // The hand is one millimeter over the table.
  hand.X_OH.translation().z() -= clearance_at(held.scene, X_WO, resting(), 0.0).hand - 0.001;
  CHECK(clearance_at(held.scene, X_WO, resting(), 0.0).hand == Approx(0.001).epsilon(1e-9));
  CHECK_FALSE(find_collision(held.scene, X_WO, resting(), 0.0005));
  const auto met = find_collision(held.scene, X_WO, resting(), 0.003);
  REQUIRE(met);
  CHECK(met->second == "table");
  // The same holds beside the wall, high over the table.
  hand.X_OH.translation().z() += 0.3;
  const double gap = clearance_at(held.scene, X_WO, resting(), 0.0).hand;
  X_WO[kWall].translation().x() -= 1.0;
  CHECK(find_collision(held.scene, X_WO, resting(), 0.0));  // The hand is in the wall.
  X_WO[kWall].translation().x() += 1.0;
  X_WO[kWall].translation().z() = 5.0;
  CHECK_FALSE(find_collision(held.scene, X_WO, resting(), 0.5 * gap));
  // The same holds with the block in hand.
  const RigidTransform X_WB = at({0, 0, 0.5});
  X_WO[kWall] = at({0.02 + 0.002 + 0.025, 0, 0.5 - 0.013 - 0.2});
  const MotionSegment carried = held.carry(MotionPhase::Transport, X_WB, X_WB);
  CHECK(clearance_at(held.scene, X_WO, carried, 0.0).object == Approx(0.002).epsilon(1e-9));
  CHECK(find_collision(held.scene, X_WO, carried, 0.003));
  CHECK_FALSE(find_collision(held.scene, X_WO, carried, 0.001));
}

TEST_CASE("The end of an approach may be near the object alone, not the table",
          "[grasp][table_motion]") {
  // The hand goes straight down beside the block, until the jaws are 4 um in the table.
  const HeldBlock held({0.01, 0.01, 0.01});
  const RigidTransform X_WB = at({0, 0.3, 0.015});
  const std::vector<RigidTransform> X_WO = {X_WB, at({1, 1, 1})};
  HandConfiguration high = held.holding(at({0, 0, 0.3}));
  MotionSegment approach{MotionPhase::Approach, kBlock, high, high, X_WB, X_WB};
  const double height = held.scene.height_of_link(
      held.scene.hand().fingers[0].links.back(),
      hands::forward_kinematics(
          held.scene.hand(),
          high)[static_cast<std::size_t>(held.scene.hand().fingers[0].links.back())],
      1.0);
  approach.to.X_OH.translation().z() -= height - 0.0001;
  CHECK_FALSE(find_collision(held.scene, X_WO, approach, 0.0));
  approach.to.X_OH.translation().z() -= 0.000104;
  const auto met = find_collision(held.scene, X_WO, approach, 0.0);
  REQUIRE(met);
  CHECK(met->second == "table");
  MotionSegment release = approach;
  release.phase = MotionPhase::Release;
  std::swap(release.from, release.to);
  CHECK(find_collision(held.scene, X_WO, release, 0.0));
}

TEST_CASE("Hulls of objects are those of their surfaces", "[grasp][table_motion]") {
  geometry::TriangleMesh stray = geometry::box({0.04, 0.04, 0.04});
  stray.vertices.push_back({0, 0, -3.0});  // This vertex belongs to no face.
  const TableScene scene(hands::find_hand("parallel_gripper"),
                         {testing::scene_object("box", stray)});
  CHECK(scene.hull_O(0).vertices.size() == 8);
  CHECK(scene.height_of_object(0, at({0, 0, 0.02})) == Approx(0.0).margin(1e-15));
}

TEST_CASE("Ends of a segment are kept to the last digit, and what is carried stays in the hand",
          "[grasp][table_motion]") {
  const HeldBlock held({0.01, 0.01, 0.01});
  RigidTransform to = at({0.2, -0.1, 0.4});
  to.linear() = Eigen::AngleAxisd(2.0, Vector3d(0.48, 0.6, 0.64)).toRotationMatrix();
  const MotionSegment segment = held.carry(MotionPhase::Transport, at({0, 0, 0.2}), to);
  CHECK(state_at(held.scene, segment, 1.0).X_WO.matrix() == to.matrix());
  CHECK(state_at(held.scene, segment, 1.0).hand.X_OH.matrix() == segment.to.X_OH.matrix());
  CHECK(state_at(held.scene, segment, 0.0).X_WO.matrix() == segment.X_WO_from.matrix());
  for (const double share : {0.1, 0.5, 0.999999}) {
    const MotionState state = state_at(held.scene, segment, share);
    CHECK((state.X_WO.inverse() * state.hand.X_OH).isApprox(held.hold.X_OH, 1e-14));
    CHECK(state.X_WO.translation().isApprox(
        (1 - share) * Vector3d(0, 0, 0.2) + share * to.translation(), 1e-14));
  }
  CHECK(largest_travel(held.scene, segment) > to.translation().norm() - 0.2);
}

TEST_CASE("What is proven free is free wherever it is looked at, and what is free is proven",
          "[grasp][table_motion]") {
  base::Random random(11);
  const HeldBlock held({0.05, 0.2, 0.25});
  const std::vector<RigidTransform> X_WO = {at({0, 0, 0.015}), at({0, 0.02, 0.125})};
  const double clearance = 0.004;
  int num_free = 0;
  int num_met = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const auto somewhere = [&] {
      RigidTransform X =
          at({random.uniform(-0.25, 0.25), random.uniform(-0.25, 0.25), random.uniform(0.1, 0.4)});
      X.linear() = Eigen::AngleAxisd(random.uniform(0.0, 1.5), testing::random_direction(random))
                       .toRotationMatrix();
      return X;
    };
    const bool carries = trial % 2 == 0;
    MotionSegment segment = held.carry(MotionPhase::Transport, somewhere(), somewhere());
    if (!carries) {
      segment.phase = MotionPhase::Reach;
      segment.X_WO_from = segment.X_WO_to = X_WO[kBlock];
      segment.to.q.setConstant(0.04);
    }
    const bool is_free = !find_collision(held.scene, X_WO, segment, clearance);
    const double travel = largest_travel(held.scene, segment);
    const int parts = static_cast<int>(std::ceil(travel / 0.001));
    double nearest = 1.0;
    bool overlaps = false;
    for (int i = 0; i <= parts; ++i) {
      const double share = static_cast<double>(i) / parts;
      const MotionClearance here = clearance_at(held.scene, X_WO, segment, share);
      nearest = std::min({nearest, here.hand, here.object});
      overlaps = overlaps || find_overlap(held.scene, X_WO, segment, share);
    }
    if (is_free) {
      CHECK(nearest > clearance - 1e-9);
      CHECK_FALSE(overlaps);
      ++num_free;
    } else {
      // Between two samples no point moves by more than 1 mm, and so distances change by 1 mm at
      // most.
      CHECK(nearest < clearance + 0.001);
      ++num_met;
    }
  }
  CHECK(num_free > 20);
  CHECK(num_met > 20);
}

TEST_CASE("Objects of one name are refused", "[grasp][table_motion]") {
  CHECK_THROWS_AS(TableScene(hands::find_hand("parallel_gripper"),
                             {testing::scene_object("a", geometry::box({1, 1, 1})),
                              testing::scene_object("a", geometry::box({1, 1, 1}))}),
                  base::InvalidInput);
}

}  // namespace test_table_motion
