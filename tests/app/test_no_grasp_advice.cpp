#include <numbers>
#include <string>
#include <vector>

#include "graspfit/geometry/shapes.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "output/no_grasp_advice.hpp"
#include "support/catch.hpp"

namespace test_no_grasp_advice {

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using grasp::AttemptOutcome;
using testing::Contains;
using testing::EndsWith;
using testing::StartsWith;

/// A box of these sizes on z = 0.
geometry::TriangleMesh box_on_table(const Vector3d& size) {
  geometry::TriangleMesh box = geometry::box(size);
  for (Vector3d& vertex : box.vertices) vertex.z() += 0.5 * size.z();
  return box;
}

/// Ten attempts of a Barrett hand on a box on a table, of which seven ended in one outcome.
struct Scene {
  hands::HandReading hand = hands::read_hand(hands::find_hand_file("barrett"));
  geometry::TriangleMesh box = box_on_table({0.06, 0.05, 0.08});
  grasp::Surroundings surroundings = {.table_z_O = 0.0, .obstacles = {}, .table_clearance = 0.001};
  grasp::PlannerOptions options;
  grasp::PlannerResult result;
  bool is_in_one_rest_pose = false;
  bool is_reach_tried = false;

  explicit Scene(AttemptOutcome outcome, const std::string& target_failure = "") {
    options.style = grasp::GraspStyle::Auto;
    options.targets.search = grasp::TargetSearch::Reach;
    options.num_contacts = 2;
    options.approach_O = -Vector3d::UnitZ();
    options.approach_angle = std::numbers::pi;
    options.max_attempts = 50;
    options.fitting.guard_self = true;
    options.targets.score_threshold = 0.0;
    surroundings.table_clearance = 0.0;
    result.statistics.attempts = 10;
    result.statistics.outcomes = {
        {AttemptOutcome::Valid, 0}, {AttemptOutcome::Unstable, 3}, {AttemptOutcome::PoorShape, 0}};
    result.statistics.outcomes[outcome] = 7;
    if (!target_failure.empty()) result.statistics.target_failures = {{target_failure, 7}};
  }

  /// Adds an obstacle far away.
  void add_obstacle() {
    geometry::TriangleMesh wall = geometry::box({0.01, 0.5, 0.2});
    for (Vector3d& vertex : wall.vertices) vertex.x() += 0.5;
    surroundings.obstacles.emplace_back(std::move(wall));
  }

  std::string advice() const {
    return app::no_grasp_advice(
        {result, options, box, hand, surroundings, is_in_one_rest_pose, is_reach_tried});
  }
};

constexpr AttemptOutcome kFailures[] = {
    AttemptOutcome::UsableOnly,     AttemptOutcome::InitialCollision, AttemptOutcome::BlockedFinger,
    AttemptOutcome::MissedContact,  AttemptOutcome::GapLeft,          AttemptOutcome::SelfCollision,
    AttemptOutcome::Rejected,       AttemptOutcome::NoWayIn,          AttemptOutcome::Weak,
    AttemptOutcome::IterationLimit, AttemptOutcome::Unstable,         AttemptOutcome::PoorShape};

}  // namespace

TEST_CASE("Over a table every outcome is told with what helps", "[app][no_grasp_advice]") {
  const std::pair<AttemptOutcome, std::string> lines[] = {
      {AttemptOutcome::UsableOnly,
       "grasps are usable but not valid: --accept usable or another --hand"},
      {AttemptOutcome::InitialCollision,
       "the open hand meets the object or the table from every side: another --hand"},
      {AttemptOutcome::BlockedFinger,
       "a finger is stopped by the object or the table before its pad touches: another --hand"},
      {AttemptOutcome::MissedContact, "a finger closes past the object: another --hand"},
      {AttemptOutcome::GapLeft,
       "not all pads come to touch while links stay clear of the table: another --hand"},
      {AttemptOutcome::SelfCollision,
       "fingers run into one another, as they do on what is narrow: another --hand"},
      {AttemptOutcome::Rejected,
       "grasps are not as --reject wants them: --reject none or another --hand"},
      {AttemptOutcome::NoWayIn,
       "no straight way in is free of the table: a smaller --pre-grasp-clearance-mm (now 5), "
       "--pre-grasps no (asks for no way in) or another --hand"},
      {AttemptOutcome::IterationLimit,
       "the hand does not come to rest at its targets: another --hand"},
      {AttemptOutcome::Weak, "all contacts are on fragile features: --no-weak or another --hand"},
      {AttemptOutcome::Unstable,
       "no two contacts face each other: a larger --theta-max-deg or another --hand"},
      {AttemptOutcome::PoorShape,
       "contacts do not surround the object's center of mass: another --hand"}};
  // All that these runs could change is at its limit but what these lines name.
  for (const auto& [outcome, line] : lines) {
    Scene scene(outcome);
    CHECK(scene.advice() == "7 of 10 attempts: " + line);
    scene.surroundings = {};
    CHECK(scene.advice().empty());
  }
  CHECK(std::size(lines) == std::size(kFailures));
}

TEST_CASE("Where no posture is found, sizes and what would help are told",
          "[app][no_grasp_advice]") {
  Scene scene(AttemptOutcome::NoTargets, "no further");
  scene.add_obstacle();
  CHECK_THAT(scene.advice(),
             StartsWith("7 of 10 attempts: no posture was found in which the hand's pads lie on "
                        "places of the object, links stay out of it and clear of the table and the "
                        "obstacles and the palm comes from where it may: these get ") &&
                 EndsWith(" mm apart, and the object is 60 x 50 x 80 mm; more room to the "
                          "obstacles or another --hand"));
  scene.surroundings = {};
  CHECK_THAT(scene.advice(), StartsWith("no posture was found") && !Contains("clear of") &&
                                 EndsWith("mm; another --hand"));
  Scene low(AttemptOutcome::NoTargets, "no seed");
  CHECK(low.advice() ==
        "7 of 10 attempts: no place of the object has a contact score above the threshold where a "
        "pad gets above the table: a higher --resolution or another --hand");
  low.surroundings = {};
  CHECK_THAT(low.advice(), StartsWith("no place of the object has a contact score above the "
                                      "threshold: lower --score-threshold"));
  for (const auto& [failure, what] : {std::pair("no second", "no two places of the object face"),
                                      std::pair("no palm", "places for the fingers are found")}) {
    Scene other(AttemptOutcome::NoTargets, failure);
    CHECK_THAT(other.advice(), StartsWith(std::string("7 of 10 attempts: ") + what));
  }
  Scene random(AttemptOutcome::NoTargets, "no further");
  random.options.targets.search = grasp::TargetSearch::Random;
  CHECK_THAT(random.advice(), StartsWith("7 of 10 attempts: two places are found"));
}

TEST_CASE("No flag is named that is at its limit, and others are with their values",
          "[app][no_grasp_advice]") {
  const auto check = [](AttemptOutcome outcome, const auto& change, const std::string& remedy) {
    CAPTURE(remedy);
    const std::string failure = outcome == AttemptOutcome::NoTargets ? "no further" : "";
    Scene scene(outcome, failure);
    CHECK_THAT(scene.advice(), !Contains(remedy));
    change(scene);
    CHECK_THAT(scene.advice(), Contains(remedy));
  };
  const AttemptOutcome blocked = AttemptOutcome::BlockedFinger;
  check(
      blocked, [](Scene& s) { s.options.num_contacts = 3; }, ": fewer --contacts (now 3) or ");
  check(
      blocked,
      [](Scene& s) {
        s.options.fingers = {"finger_1", "finger_2", "thumb"};
      },
      ": fewer --fingers or ");
  check(
      blocked, [](Scene& s) { s.options.palm = true; },
      ": fewer --contacts (now 2), --no-palm or ");
  check(
      blocked, [](Scene& s) { s.options.style = grasp::GraspStyle::Precision; },
      ": --style auto or ");
  check(
      blocked, [](Scene& s) { s.options.targets.search = grasp::TargetSearch::Random; },
      ": --preset strong (targets where the hand can reach) or ");
  check(
      blocked, [](Scene& s) { s.surroundings.table_clearance = 0.0045; },
      ": a smaller --table-clearance-mm (now 4.5) or ");
  check(
      blocked, [](Scene& s) { s.add_obstacle(); },
      "the table and the obstacles before its pad touches: more room to the obstacles or ");
  check(
      blocked, [](Scene& s) { s.options.max_attempts = 10; }, ": more --max-attempts (now 10) or ");
  check(
      AttemptOutcome::NoWayIn, [](Scene& s) { s.options.approach_O.reset(); },
      "the table: --approach 0,0,-1 (from above), ");
  check(
      AttemptOutcome::NoWayIn, [](Scene& s) { s.options.approach_angle = std::numbers::pi / 6; },
      "the table: a wider --approach-angle-deg (now 30), ");
  check(
      AttemptOutcome::SelfCollision, [](Scene& s) { s.options.fitting.guard_self = false; },
      ": --guard-self yes or ");
  check(
      AttemptOutcome::UsableOnly, [](Scene& s) { s.options.contact_score_threshold = 0.3; },
      ": a lower --contact-score-threshold, --accept usable or ");
  check(
      AttemptOutcome::NoTargets, [](Scene& s) { s.options.targets.score_threshold = 0.6; },
      "; a lower --score-threshold (now 0.6) or ");
  // A millimeter of 80 takes nothing from an object.
  Scene near(blocked);
  near.surroundings.table_clearance = 0.001;
  CHECK_THAT(near.advice(), !Contains("--table-clearance-mm"));
  // What was tried before or has no targets does not get them by reach.
  Scene scene(blocked);
  scene.options.targets.search = grasp::TargetSearch::Random;
  scene.is_reach_tried = true;
  CHECK_THAT(scene.advice(), !Contains("--preset"));
  scene.is_reach_tried = false;
  scene.options.planner = "gs";
  CHECK_THAT(scene.advice(), !Contains("--preset"));
}

TEST_CASE("A flat object is told to be low beside the fingertips, and how it stands higher",
          "[app][no_grasp_advice]") {
  Scene scene(AttemptOutcome::MissedContact);
  scene.box = box_on_table({0.06, 0.05, 0.004});
  CHECK_THAT(scene.advice(), Contains("the object raised or tilted (it is 4 mm high, and the "
                                      "fingertips are "));
  // It comes to rest on a long edge in less than 1 % of falls.
  scene.is_in_one_rest_pose = true;
  CHECK_THAT(scene.advice(), !Contains("--rest-pose"));
  scene.box = box_on_table({0.06, 0.05, 0.03});
  CHECK_THAT(scene.advice(),
             Contains("--rest-pose 5 (the object is then 60 mm high, not 30) or another --hand"));
  scene.is_in_one_rest_pose = false;
  CHECK_THAT(scene.advice(), !Contains("--rest-pose"));
  // It stands as high as it can.
  scene.is_in_one_rest_pose = true;
  scene.box = box_on_table({0.03, 0.05, 0.06});
  CHECK_THAT(scene.advice(), !Contains("--rest-pose"));
}

TEST_CASE("A run without attempts and one that is suspicious of its hand have their own advice",
          "[app][no_grasp_advice]") {
  Scene scene(AttemptOutcome::GapLeft);
  scene.result.statistics.attempts = 0;
  scene.result.statistics.outcomes = {{AttemptOutcome::Valid, 0}, {AttemptOutcome::GapLeft, 0}};
  CHECK(scene.advice().empty());
  scene.hand.findings.push_back({hands::FindingKind::Suspicious, "finger", "far away"});
  CHECK(scene.advice() == "what is suspicious about the hand, above, may be why");
  scene.result.statistics.outcomes[AttemptOutcome::GapLeft] = 1;
  CHECK_THAT(scene.advice(), EndsWith("--hand; what is suspicious about the hand, above, may be "
                                      "why"));
}

}  // namespace test_no_grasp_advice
