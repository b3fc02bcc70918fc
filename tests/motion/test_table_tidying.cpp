#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/sha256.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "graspfit/motion/motion_io.hpp"
#include "graspfit/motion/table_tidying.hpp"
#include "motion/table_scenes.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_table_tidying {

using namespace graspfit;
using namespace graspfit::motion;
using namespace graspfit::grasp;
using Eigen::Vector3d;
using geometry::RigidTransform;
using testing::at;

namespace {

PickAndPlaceOptions options_for(const hands::HandModel& hand) {
  PickAndPlaceOptions options;
  options.planner.num_contacts = 2;
  options.planner.count = 4;
  options.planner.max_attempts = 12;
  options.planner.weak.reset();
  options.home = hands::open_configuration(hand);
  options.home.X_OH.linear() =
      Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitX()).toRotationMatrix();
  options.home.X_OH.translation() = Vector3d(0.0, -0.1, 0.5);
  return options;
}

TableScene two_blocks() {
  return TableScene(hands::find_hand("parallel_gripper"),
                    {testing::scene_object("red", geometry::box({0.04, 0.05, 0.06})),
                     testing::scene_object("blue", geometry::box({0.05, 0.04, 0.06}))});
}

/// Checks that each segment begins where the last one ends, and that the first and last are at
/// home.
void check_chain(const PlannedMove& move, const PickAndPlaceOptions& options) {
  REQUIRE(move.segments.size() >= 7);
  CHECK(move.segments.front().from.X_OH.matrix() == options.home.X_OH.matrix());
  CHECK(move.segments.back().to.X_OH.matrix() == options.home.X_OH.matrix());
  CHECK(move.segments.front().X_WO_from.matrix() == move.X_WO_from.matrix());
  CHECK(move.segments.back().X_WO_to.matrix() == move.X_WO_to.matrix());
  for (std::size_t i = 0; i + 1 < move.segments.size(); ++i) {
    const MotionSegment& a = move.segments[i];
    const MotionSegment& b = move.segments[i + 1];
    CHECK(a.to.X_OH.isApprox(b.from.X_OH, 1e-12));
    CHECK(a.to.q == b.from.q);
    CHECK(a.X_WO_to.matrix() == b.X_WO_from.matrix());
    CHECK(static_cast<int>(a.phase) <= static_cast<int>(b.phase));
  }
}

/// Makes exact tests at samples so close that no point moves by more than half a millimeter between
/// two.
void check_free(const TableScene& scene, std::vector<RigidTransform> X_WO,
                const std::vector<PlannedMove>& moves) {
  for (const PlannedMove& move : moves) {
    for (const MotionSegment& segment : move.segments) {
      const int samples = static_cast<int>(std::ceil(largest_travel(scene, segment) / 0.0005));
      const auto met = testing::sampled_overlap(scene, X_WO, segment, std::max(samples, 1));
      INFO(phase_name(segment.phase) << (met ? ": " + met->text() : ""));
      CHECK_FALSE(met);
    }
    X_WO[static_cast<std::size_t>(move.object)] = move.X_WO_to;
  }
}

}  // namespace

TEST_CASE("A block is picked up, turned over and put down at its goal", "[grasp][pick_and_place]") {
  const TableScene scene(hands::find_hand("parallel_gripper"),
                         {testing::scene_object("tower", geometry::box({0.04, 0.06, 0.16})),
                          testing::scene_object("blue", geometry::box({0.05, 0.04, 0.06}))});
  PickAndPlaceOptions options = options_for(scene.hand());
  options.planner.max_attempts = 60;
  const std::vector<RigidTransform> start = {at({-0.1, 0, 0.08}), at({0.02, 0.12, 0.03}, 0.3)};
  // At the goal the block is on its side: what was along y is up.
  RigidTransform goal = at({0.14, -0.05, 0.03});
  goal.linear() = Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitX()).toRotationMatrix();
  const MoveAttempt attempt = plan_move(scene, start, 0, goal, options);
  INFO(attempt.reason());
  REQUIRE(attempt.move);
  check_chain(*attempt.move, options);
  CHECK(attempt.move->X_WO_to.matrix() == goal.matrix());
  CHECK(attempt.move->grasp.is_valid());
  // Half open fingers would stand around the object as the palm withdraws.
  CHECK(attempt.move->grasp.pre_grasp->opening == 1.0);
  check_free(scene, start, {*attempt.move});
  CHECK(attempt.segments_tried == attempt.move->segments_tried);
}

TEST_CASE("A move is refused with its reason where there is none", "[grasp][pick_and_place]") {
  PickAndPlaceOptions options = options_for(hands::find_hand("parallel_gripper"));
  options.planner.max_attempts = 4;
  SECTION("the goal is taken") {
    const TableScene scene = two_blocks();
    const std::vector<RigidTransform> start = {at({-0.1, 0, 0.03}), at({0.1, 0, 0.03})};
    const MoveAttempt attempt = plan_move(scene, start, 0, at({0.08, 0.02, 0.03}), options);
    CHECK_FALSE(attempt.move);
    CHECK(attempt.reason() == "the goal is taken by blue");
    CHECK(attempt.planner_attempts == 0);
  }
  SECTION("the object is under a lid") {
    // A plate is 20 mm above the block, wide enough that no finger reaches around it.
    const TableScene scene(hands::find_hand("parallel_gripper"),
                           {testing::scene_object("block", geometry::box({0.04, 0.05, 0.06})),
                            testing::scene_object("lid", geometry::box({1.0, 1.0, 0.01}))});
    const std::vector<RigidTransform> start = {at({0, 0, 0.03}), at({0, 0, 0.085})};
    options.home.X_OH.translation().z() = 0.6;
    const MoveAttempt attempt = plan_move(scene, start, 0, at({0.8, 0, 0.03}), options);
    CHECK_FALSE(attempt.move);
    CHECK_FALSE(attempt.reason().empty());
  }
}

TEST_CASE("Whether an object fits the hand does not depend on how it is turned",
          "[grasp][pick_and_place]") {
  // The board is 40 mm thick, but 170 mm wide in both directions of the table where it stands
  // turned by 45 degrees.
  const TableScene scene(hands::find_hand("parallel_gripper"),
                         {testing::scene_object("board", geometry::box({0.04, 0.2, 0.25}))});
  PickAndPlaceOptions options = options_for(scene.hand());
  options.planner.max_attempts = 40;
  options.home.X_OH.translation().z() = 0.7;
  const std::vector<RigidTransform> start = {at({-0.1, 0, 0.125}, 0.25 * std::numbers::pi)};
  const MoveAttempt attempt = plan_move(scene, start, 0, at({0.2, 0, 0.125}, 0.5), options);
  INFO(attempt.reason());
  CHECK(attempt.planner_attempts > 0);
  for (const auto& [reason, count] : attempt.failures) {
    CHECK(reason.find("measures") == std::string::npos);
  }
}

TEST_CASE("An object of impossible size stays, and the others are moved all the same",
          "[grasp][table_tidying]") {
  const TableScene scene(hands::find_hand("parallel_gripper"),
                         {testing::scene_object("chest", geometry::box({0.2, 0.2, 0.2})),
                          testing::scene_object("crumb", geometry::box({0.004, 0.004, 0.004})),
                          testing::scene_object("red", geometry::box({0.04, 0.05, 0.06}))});
  TidyingOptions options;
  options.move = options_for(scene.hand());
  const std::vector<RigidTransform> start = {at({-0.3, 0, 0.1}), at({0.2, 0.2, 0.002}),
                                             at({0.1, 0, 0.03})};
  const std::vector<RigidTransform> goal = {at({-0.3, 0.3, 0.1}), at({0.2, 0.3, 0.002}),
                                            at({0.1, 0.15, 0.03})};
  const TidyingResult result = tidy_table(scene, start, goal, options);
  REQUIRE(result.moves.size() == 1);
  CHECK(result.moves[0].object == 2);
  REQUIRE(result.unmoved.size() == 2);
  CHECK(result.unmoved[0].object == 0);
  CHECK(result.unmoved[0].reason.find("the object measures 0.2 x 0.2 x 0.2 m, hand "
                                      "parallel_gripper spans at most") == 0);
  CHECK(result.unmoved[1].object == 1);
  CHECK(result.unmoved[1].reason.find("less than one fingertip") != std::string::npos);
}

TEST_CASE("A grasp has room over the table at the goal too, lower, upside down or far away",
          "[grasp][pick_and_place]") {
  // A flat block that stands 0.1 m high is grasped from the side by a hand thicker than the block,
  // for which there is no space on the table.
  const TableScene scene(hands::find_hand("parallel_gripper"),
                         {testing::scene_object("tile", geometry::box({0.05, 0.04, 0.012}))});
  PickAndPlaceOptions options = options_for(scene.hand());
  options.planner.max_attempts = 40;
  options.planner.approach_angle = 0.1;
  options.approaches_W = {Vector3d(2.0, 0.0, 0.0)};
  const RigidTransform high = at({0, 0, 0.3});
  const MoveAttempt level = plan_move(scene, std::vector{high}, 0, at({0, 0.2, 0.3}), options);
  INFO(level.reason());
  CHECK(level.grasps_tried > 0);
  if (level.move) CHECK(level.move->approach_W == Vector3d::UnitX());

  RigidTransform over = at({2.7, -2.2, 0.006});
  over.linear() = Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitX()).toRotationMatrix();
  for (const RigidTransform& goal : {at({0, 0.2, 0.006}), over}) {
    const MoveAttempt attempt = plan_move(scene, std::vector{high}, 0, goal, options);
    INFO(attempt.reason());
    CHECK(attempt.planner_attempts > 0);
    CHECK(attempt.grasps_tried == 0);
  }
}

TEST_CASE(
    "A palm that starts in the object is no error, and where no grasp is tried none has failed",
    "[grasp][pick_and_place]") {
  const TableScene scene = two_blocks();
  PickAndPlaceOptions options = options_for(scene.hand());
  options.planner.max_attempts = 4;
  const std::vector<RigidTransform> start = {at({-0.1, 0, 0.03}), at({0.1, 0, 0.03})};
  // The palm center is exactly at the block's center.
  options.home.X_OH = RigidTransform::Identity();
  options.home.X_OH.translation() = start[0].translation() - scene.hand().palm.center_H;
  REQUIRE(options.home.X_OH * scene.hand().palm.center_H == start[0].translation());
  CHECK_NOTHROW(plan_move(scene, start, 0, at({0.0, 0.15, 0.03}), options));

  // Without a candidate there is no outcome to name.
  options = options_for(scene.hand());
  options.planner.planner = "ma";
  options.planner.medial_symmetry.samples = 1;
  const MoveAttempt none = plan_move(scene, start, 0, at({0.0, 0.15, 0.03}), options);
  CHECK(none.planner_attempts == 0);
  CHECK(none.reason() ==
        "no valid grasp with room at start and goal in 0 attempts (no candidate) (2)");
}

TEST_CASE("Pick-and-place options out of range are refused by name", "[grasp][pick_and_place]") {
  const PickAndPlaceOptions good = options_for(hands::find_hand("parallel_gripper"));
  CHECK_NOTHROW(good.validate());
  const auto refusal = [&](const auto& change) {
    PickAndPlaceOptions options = good;
    change(options);
    try {
      options.validate();
    } catch (const base::InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  const auto starts = [](const std::string& field) { return testing::StartsWith(field); };
  CHECK_THAT(refusal([](auto& o) { o.lifts.clear(); }), starts("PickAndPlaceOptions: lifts = 0"));
  CHECK_THAT(refusal([](auto& o) {
               o.lifts = {0.1, -0.2};
             }),
             starts("PickAndPlaceOptions: lifts = -0.2"));
  CHECK_THAT(refusal([](auto& o) { o.withdrawals.clear(); }),
             starts("PickAndPlaceOptions: withdrawals = 0"));
  CHECK_THAT(refusal([](auto& o) { o.withdrawals = {0.0}; }),
             starts("PickAndPlaceOptions: withdrawals = 0"));
  CHECK_THAT(refusal([](auto& o) {
               o.approaches_W = {Vector3d::UnitX(), Vector3d::Zero()};
             }),
             starts("PickAndPlaceOptions: approaches_W = 0"));
  CHECK_THAT(refusal([](auto& o) { o.planner.acceptance = Acceptance::Usable; }),
             starts("PickAndPlaceOptions: planner.acceptance = usable"));
  CHECK_THAT(refusal([](auto& o) { o.planner.pre_grasps = false; }),
             starts("PickAndPlaceOptions: planner.pre_grasps = false"));
  CHECK_THAT(refusal([](auto& o) { o.clearance = -0.001; }),
             starts("PickAndPlaceOptions: clearance = -0.001"));
}

TEST_CASE("Two blocks that change places need a third place, and one that is in the way goes first",
          "[grasp][table_tidying]") {
  const TableScene scene = two_blocks();
  TidyingOptions options;
  options.move = options_for(scene.hand());
  options.max_moves_tried = 12;
  const RigidTransform left = at({-0.12, 0, 0.03});
  const RigidTransform right = at({0.12, 0, 0.03});

  SECTION("in the way") {
    // The red block wants to stand where the blue one is, and the blue one wants to go elsewhere.
    const std::vector<RigidTransform> start = {left, right};
    const std::vector<RigidTransform> goal = {right, at({0.0, 0.15, 0.03})};
    const TidyingResult result = tidy_table(scene, start, goal, options);
    CHECK(result.unmoved.empty());
    REQUIRE(result.moves.size() == 2);
    CHECK(result.moves[0].object == 1);
    CHECK(result.moves[1].object == 0);
    for (std::size_t i = 0; i < 2; ++i) CHECK(result.X_WO_end[i].matrix() == goal[i].matrix());
    check_free(scene, start, result.moves);
  }
  SECTION("change of places") {
    const std::vector<RigidTransform> start = {left, right};
    const std::vector<RigidTransform> goal = {right, left};
    const TidyingResult stuck = tidy_table(scene, start, goal, options);
    CHECK(stuck.moves.empty());
    REQUIRE(stuck.unmoved.size() == 2);
    CHECK(stuck.unmoved[0].reason == "the goal is taken by blue");
    CHECK(stuck.unmoved[1].reason == "the goal is taken by red");

    options.resting_places_W = {{0.0, 0.15}};
    const TidyingResult result = tidy_table(scene, start, goal, options);
    CHECK(result.unmoved.empty());
    REQUIRE(result.moves.size() == 3);
    CHECK(result.moves[0].object == result.moves[2].object);
    CHECK(result.moves[1].object != result.moves[0].object);
    for (std::size_t i = 0; i < 2; ++i) CHECK(result.X_WO_end[i].matrix() == goal[i].matrix());
    check_free(scene, start, result.moves);
  }
  SECTION("nothing to do") {
    const TidyingResult result = tidy_table(scene, {left, right}, {left, right}, options);
    CHECK(result.moves.empty());
    CHECK(result.unmoved.empty());
  }
  SECTION("bad input") {
    CHECK_THROWS_AS(tidy_table(scene, {left, left}, {left, right}, options), base::InvalidInput);
    CHECK_THROWS_AS(tidy_table(scene, {left}, {left, right}, options), base::InvalidInput);
    CHECK_THROWS_AS(tidy_table(scene, {left, at({0.12, 0, 0.02})}, {left, right}, options),
                    base::InvalidInput);
    options.resting_places_W = {{0.1, std::nan("")}};
    CHECK_THROWS_WITH(tidy_table(scene, {left, right}, {left, right}, options),
                      testing::Contains("resting_places_W = 0.1, nan"));
    options.resting_places_W.clear();
    options.move.clearance = options.move.planner.pre_grasp.clearance;
    CHECK_THROWS_AS(tidy_table(scene, {left, right}, {left, right}, options), base::InvalidInput);
  }
}

TEST_CASE("Motion files are the same bytes for the same table and are read back",
          "[grasp][motion_io]") {
  const TableScene scene = two_blocks();
  TidyingOptions options;
  options.move = options_for(scene.hand());
  const std::vector<RigidTransform> start = {at({-0.12, 0, 0.03}), at({0.12, 0, 0.03})};
  const std::vector<RigidTransform> goal = {at({0.0, 0.15, 0.03}, 1.0), start[1]};
  const auto text = [&] {
    const TidyingResult result = tidy_table(scene, start, goal, options);
    MotionFile file = make_motion_file(
        scene, {{"red", "shape box", "", 1.0, {}, {}}, {"blue", "shape box", "", 1.0, {}, {}}},
        goal, result, options);
    file.title = "Blocks";
    file.hand = "parallel_gripper";
    return to_json(file);
  };
  const std::string written = text();
  CHECK(written == text());

  const testing::TemporaryFolder folder;
  const auto path = folder.path() / "motion.json";
  base::write_file_atomically(path, written);
  const MotionFile read = read_motion(path);
  REQUIRE(read.moves.size() == 1);
  const auto poses = object_poses(read);
  REQUIRE(poses.size() == 2);
  CHECK((poses[1][0].matrix() - goal[0].matrix()).norm() < 1e-12);
  CHECK(poses[1][1].matrix() == poses[0][1].matrix());
  base::write_file_atomically(path, to_json(read));
  const MotionFile twice = read_motion(path);
  for (std::size_t i = 0; i < read.moves[0].segments.size(); ++i) {
    const MotionSegment& once = read.moves[0].segments[i];
    const MotionSegment& again = twice.moves[0].segments[i];
    CHECK(once.phase == again.phase);
    CHECK((once.to.X_OH.matrix() - again.to.X_OH.matrix()).norm() < 1e-14);
    CHECK((once.X_WO_to.matrix() - again.X_WO_to.matrix()).norm() < 1e-14);
    CHECK(once.to.q == again.to.q);
  }
  const TableScene same = read_motion_scene(read, folder.path());
  CHECK(same.objects().size() == 2);
  CHECK(same.hand().name == scene.hand().name);

  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string changed = written;
    changed.replace(changed.find(from), from.size(), to);
    base::write_file_atomically(path, changed);
    try {
      read_motion_scene(read_motion(path), folder.path());
    } catch (const base::IoError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refused("\"reach\"", "\"jump\"").find("/moves/0/to/0/phase: is \"jump\"") !=
        std::string::npos);
  CHECK(refused("\"version\": 1", "\"version\": 7").find("/version") != std::string::npos);
  CHECK(refused("\"description_sha256\": \"", "\"description_sha256\": \"0").find("SHA-256") !=
        std::string::npos);
  CHECK_THROWS_AS(make_motion_file(scene, {{"red", "shape box", "", 1.0, {}, {}}}, goal,
                                   tidy_table(scene, start, start, options), options),
                  base::InvalidInput);
}

TEST_CASE("A motion file that contradicts itself, its hand or its objects is refused",
          "[grasp][motion_io]") {
  // The file is that of a hand that takes a box from the shape library 50 mm aside.
  const hands::HandModel hand = hands::find_hand("parallel_gripper");
  const testing::TemporaryFolder folder;
  const auto mesh = folder.path() / "block.off";
  geometry::write_mesh(mesh, geometry::box({0.04, 0.05, 0.06}));
  MotionFile file;
  file.title = "By hand";
  file.hand = "parallel_gripper";
  file.description_sha256 = hand.description_sha256;
  for (const hands::Joint& joint : hand.joints) file.joints.push_back(joint.name);
  const RigidTransform start = at({0, 0, 0.03});
  const RigidTransform goal = at({0.05, 0, 0.03}, 0.4);
  file.objects = {
      {"block", "block.off", base::sha256_hex(base::read_file(mesh)), 1.0, start, goal}};
  const auto holding = [&](const RigidTransform& X_WO, double q) {
    hands::HandConfiguration configuration = hands::open_configuration(hand);
    configuration.q.setConstant(q);
    configuration.X_OH = X_WO * at({0.0, 0.01, 0.2}, 0.3);
    return configuration;
  };
  RigidTransform high = start;
  high.translation().z() += 0.1;
  const auto home = holding(high, 0.04);
  const auto move = [&](const RigidTransform& from, const RigidTransform& to) {
    return RecordedMove{
        0,
        0.5,
        2,
        {{MotionPhase::Reach, 0, home, holding(from, 0.03), from, from},
         {MotionPhase::Approach, 0, holding(from, 0.03), holding(from, 0.02), from, from},
         {MotionPhase::Transport, 0, holding(from, 0.02), holding(to, 0.02), from, to},
         {MotionPhase::Release, 0, holding(to, 0.02), holding(to, 0.03), to, to},
         {MotionPhase::Retreat, 0, holding(to, 0.03), home, to, to}}};
  };
  file.moves = {move(start, high), move(high, goal)};
  const auto path = folder.path() / "motion.json";
  const auto refusal = [&](const auto& change) {
    MotionFile changed = file;
    change(changed);
    base::write_file_atomically(path, to_json(changed));
    try {
      read_motion_scene(read_motion(path), folder.path());
    } catch (const base::IoError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  // Segments share their keyframes: where one is changed, the next begins there.
  const auto moved = [](MotionFile & changed, std::size_t at_move, std::size_t segment) -> auto& {
    return changed.moves[at_move].segments[segment];
  };
  using testing::Contains;
  CHECK(refusal([](MotionFile&) {}) == "accepted");
  CHECK(refusal([&](auto& f) { moved(f, 0, 2).to.q[0] += 1e-11; }) == "accepted");
  CHECK_THAT(refusal([&](auto& f) { moved(f, 0, 0).X_WO_to.translation().x() += 2e-9; }),
             Contains("motion.json: /moves/0/to/0/X_WO: is not where the object stood"));
  CHECK_THAT(refusal([&](auto& f) { moved(f, 1, 2).to.q[0] += 2e-9; }),
             Contains("/moves/1/to/2/q: is not as before") && Contains("transport"));
  CHECK_THAT(refusal([&](auto& f) { moved(f, 1, 2).to.X_OH.translation().y() += 2e-9; }),
             Contains("/moves/1/to/2/X_WH: is not the hand's place against the object"));
  CHECK_THAT(refusal([&](auto& f) { f.objects[0].X_WO_start = goal; }),
             Contains("/moves/0/from/X_WO: is not where the object stands then"));
  CHECK_THAT(refusal([&](auto& f) { f.moves[1] = f.moves[0]; }),
             Contains("/moves/1/from/X_WO: is not where the object stands then"));
  CHECK_THAT(refusal([&](auto& f) { moved(f, 1, 0).from.X_OH.translation().z() += 0.01; }),
             Contains("/moves/1/from/X_WH: is not where the move before has left the hand"));
  CHECK_THAT(refusal([&](auto& f) { moved(f, 1, 0).from.q[0] += 0.01; }),
             Contains("/moves/1/from/q: is not as the move before"));
  CHECK_THAT(refusal([&](auto& f) { moved(f, 0, 0).to.q[0] = 1.0; }),
             Contains("/moves/0/to/0/q: ") && Contains(" at 1 is outside "));
  CHECK_THAT(refusal([&](auto& f) { moved(f, 0, 0).from.q[0] = 1.0; }),
             Contains("/moves/0/from/q: ") && Contains(" at 1 is outside "));
  CHECK_THAT(
      refusal([&](auto& f) { f.joints[0] = "elbow"; }),
      Contains("/hand/joints/0: is elbow, of hand parallel_gripper it is " + hand.joints[0].name));
  CHECK_THAT(refusal([&](auto& f) { f.objects[0].sha256[0] = 'x'; }),
             Contains("object block.off is not the one recorded") && Contains("SHA-256"));
}

}  // namespace test_table_tidying
