#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/grasp/motion_io.hpp"
#include "graspfit/grasp/table_tidying.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"
#include "table_scenes.hpp"

using namespace graspfit;
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

/// Each stretch begins where the last one ends, the first and last at home.
void check_chain(const PlannedMove& move, const PickAndPlaceOptions& options) {
  REQUIRE(move.stretches.size() >= 7);
  CHECK(move.stretches.front().from.X_OH.matrix() == options.home.X_OH.matrix());
  CHECK(move.stretches.back().to.X_OH.matrix() == options.home.X_OH.matrix());
  CHECK(move.stretches.front().X_WO_from.matrix() == move.X_WO_from.matrix());
  CHECK(move.stretches.back().X_WO_to.matrix() == move.X_WO_to.matrix());
  for (std::size_t i = 0; i + 1 < move.stretches.size(); ++i) {
    const MotionStretch& a = move.stretches[i];
    const MotionStretch& b = move.stretches[i + 1];
    CHECK(a.to.X_OH.isApprox(b.from.X_OH, 1e-12));
    CHECK(a.to.q == b.from.q);
    CHECK(a.X_WO_to.matrix() == b.X_WO_from.matrix());
    CHECK(static_cast<int>(a.phase) <= static_cast<int>(b.phase));
  }
}

/// Exact tests on places that no point leaves by more than half a millimeter.
void check_free(const TableScene& scene, std::vector<RigidTransform> X_WO,
                const std::vector<PlannedMove>& moves) {
  for (const PlannedMove& move : moves) {
    for (const MotionStretch& stretch : move.stretches) {
      const int samples = static_cast<int>(std::ceil(largest_travel(scene, stretch) / 0.0005));
      const auto met = testing::sampled_overlap(scene, X_WO, stretch, std::max(samples, 1));
      INFO(phase_name(stretch.phase) << (met ? ": " + met->text() : ""));
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
  // On its side: what was along y is up.
  RigidTransform goal = at({0.14, -0.05, 0.03});
  goal.linear() = Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitX()).toRotationMatrix();
  const MoveAttempt attempt = plan_move(scene, start, 0, goal, options);
  INFO(attempt.reason());
  REQUIRE(attempt.move);
  check_chain(*attempt.move, options);
  CHECK(attempt.move->X_WO_to.matrix() == goal.matrix());
  CHECK(attempt.move->grasp.is_valid());
  // Half open fingers would stand around the object when the palm withdraws.
  CHECK(attempt.move->grasp.pre_grasp->opening == 1.0);
  check_free(scene, start, {*attempt.move});
  CHECK(attempt.stretches_tried == attempt.move->stretches_tried);
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
    // A plate 20 mm above the block, wide enough that no finger reaches around it.
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

TEST_CASE("Two blocks that change places need a third place, and one that is in the way goes first",
          "[grasp][table_tidying]") {
  const TableScene scene = two_blocks();
  TidyingOptions options;
  options.move = options_for(scene.hand());
  options.max_moves_tried = 12;
  const RigidTransform left = at({-0.12, 0, 0.03});
  const RigidTransform right = at({0.12, 0, 0.03});

  SECTION("in the way") {
    // Red wants to stand where blue is; blue wants to go elsewhere.
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
    CHECK_THROWS_AS(tidy_table(scene, {left, left}, {left, right}, options),
                    geometry::InvalidInput);
    CHECK_THROWS_AS(tidy_table(scene, {left}, {left, right}, options), geometry::InvalidInput);
    CHECK_THROWS_AS(tidy_table(scene, {left, at({0.12, 0, 0.02})}, {left, right}, options),
                    geometry::InvalidInput);
    options.move.clearance = options.move.planner.pre_grasp.clearance;
    CHECK_THROWS_AS(tidy_table(scene, {left, right}, {left, right}, options),
                    geometry::InvalidInput);
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
  geometry::write_file_atomically(path, written);
  const MotionFile read = read_motion(path);
  REQUIRE(read.moves.size() == 1);
  const auto poses = object_poses(read);
  REQUIRE(poses.size() == 2);
  CHECK((poses[1][0].matrix() - goal[0].matrix()).norm() < 1e-12);
  CHECK(poses[1][1].matrix() == poses[0][1].matrix());
  geometry::write_file_atomically(path, to_json(read));
  const MotionFile twice = read_motion(path);
  for (std::size_t i = 0; i < read.moves[0].stretches.size(); ++i) {
    const MotionStretch& once = read.moves[0].stretches[i];
    const MotionStretch& again = twice.moves[0].stretches[i];
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
    geometry::write_file_atomically(path, changed);
    try {
      read_motion_scene(read_motion(path), folder.path());
    } catch (const geometry::IoError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refused("\"reach\"", "\"jump\"").find("/moves/0/to/0/phase: is \"jump\"") !=
        std::string::npos);
  CHECK(refused("\"version\": 1", "\"version\": 7").find("/version") != std::string::npos);
  CHECK(refused("\"description_sha256\": \"", "\"description_sha256\": \"0").find("SHA-256") !=
        std::string::npos);
}
