#include <set>
#include <sstream>
#include <string>

#include "grasp/guidance_scene.hpp"
#include "grasp/planner_promises.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "support/catch.hpp"

namespace test_planning_methods {

namespace {

using graspfit::testing::Contains;
using namespace graspfit;
using namespace graspfit::testing;

std::string some_method() {
  return GENERATE(std::string("fitting"), std::string("gs-targets"), std::string("gs"),
                  std::string("ma"), std::string("ma-full-retreat"));
}

TEST_CASE("Methods have names and titles of their own", "[grasp][planning_methods]") {
  std::set<std::string_view> names, titles;
  for (const grasp::PlanningMethod& method : grasp::planning_methods().all()) {
    names.insert(method.name);
    titles.insert(method.title);
    CHECK(&grasp::planning_methods().at(method.name) == &method);
  }
  CHECK(names.size() == grasp::planning_methods().all().size());
  CHECK(titles.size() == names.size());
  CHECK(grasp::planning_methods().names() == "fitting|gs-targets|gs|ma|ma-full-retreat");
  CHECK_THROWS_AS(grasp::planning_methods().at("Fitting"), base::InvalidInput);

  grasp::PlanningMethods methods = grasp::planning_methods();
  grasp::PlanningMethod method = methods.at("gs");
  CHECK_THROWS_WITH(methods.add(method), Contains("name = gs, must be new"));
  method.name = "mine";
  method.title = "";
  CHECK_THROWS_WITH(methods.add(method), Contains("title of mine"));
  method.title = "one of mine";
  method.make = nullptr;
  CHECK_THROWS_WITH(methods.add(method), Contains("make of mine"));
  method.make = methods.at("gs").make;
  methods.add(method);
  CHECK(methods.names() == "fitting|gs-targets|gs|ma|ma-full-retreat|mine");
  CHECK(grasp::planning_methods().find("mine") == nullptr);
}

TEST_CASE("Valid grasps of every method keep every promise", "[grasp][planning_methods]") {
  PlannerOptions options = collecting(Acceptance::Valid, 2, 150);
  options.planner = some_method();
  // MA wraps fingers around a capsule, so that all pads count.
  options.counted_pads = contact::CountedPads::All;
  INFO(options.planner);
  const Run run(geometry::capsule(0.03, 0.08), options);
  const PlannerResult result = run.plan();
  CHECK(broken_promises(run, result) == kNothing);
  CHECK_FALSE(result.grasps.empty());
}

TEST_CASE("Usable grasps of every method that starts clear keep every promise",
          "[grasp][planning_methods]") {
  const std::string planner = GENERATE(std::string("gs"), std::string("ma-full-retreat"));
  PlannerOptions options = at_voxel_level(planner);
  options.max_attempts = 60;
  options.count = 1000;
  options.distinct = {0.0, 0.0, 0.0};
  // MA wraps fingers around a capsule, so that all pads count.
  options.counted_pads = contact::CountedPads::All;
  INFO(options.planner);
  const Run run(geometry::capsule(0.03, 0.08), options);
  const PlannerResult result = run.plan();
  CHECK(broken_promises(run, result) == kNothing);
  CHECK(static_cast<std::int64_t>(result.grasps.size()) == result.statistics.usable());
  CHECK_FALSE(result.grasps.empty());
}

TEST_CASE("Grasps of high quality of a method without targets have M of 0.6 at least",
          "[grasp][planning_methods]") {
  PlannerOptions options = at_voxel_level("gs");
  options.rejection = grasp::Rejection::Quality;
  options.max_attempts = 60;
  options.count = 1000;
  options.distinct = {0.0, 0.0, 0.0};
  const Run run(geometry::capsule(0.03, 0.08), options);
  const PlannerResult result = run.plan();
  CHECK(broken_promises(run, result) == kNothing);
  CHECK(result.statistics.outcomes.at(grasp::AttemptOutcome::Rejected) > 0);
  for (const Grasp& grasp : result.grasps) CHECK(grasp.quality.m >= 0.6);
}

TEST_CASE("Same seed, same bytes, for every method and any number of threads",
          "[grasp][planning_methods]") {
  PlannerOptions options = at_voxel_level(some_method());
  options.max_attempts = 24;
  options.count = 10;
  options.search = SearchRule::First;
  INFO(options.planner);
  const Run run(geometry::torus(0.05, 0.018), options);
  const std::string once = all_fields(run.plan(1));
  CHECK(once == all_fields(run.plan(3)));
  CHECK(once == all_fields(run.plan(1)));
  PlannerOptions other = options;
  other.seed = 2;
  CHECK(once !=
        all_fields(grasp::plan_grasps(run.object, run.hand, other, {}, {.num_threads = 2})));
}

TEST_CASE("Candidates of MA are tried once each, and then there is nothing left",
          "[grasp][planning_methods]") {
  PlannerOptions options = at_voxel_level("ma");
  // They are on a bar whose axis all balls share.
  options.medial_symmetry.samples = 6;
  options.medial_symmetry.search_radius = 0.2;
  options.max_attempts = 1000;
  options.count = 1000;
  const Run run(geometry::capsule(0.02, 0.1), options);
  const PlannerResult result = run.plan();
  CHECK(result.stop == PlannerStop::Exhausted);
  CHECK(result.statistics.attempts == result.statistics.guidance.at("candidates"));
  CHECK(result.statistics.attempts > 0);
}

TEST_CASE("An object on which MA has no candidate ends without an attempt, and says why",
          "[grasp][planning_methods]") {
  PlannerOptions options = at_voxel_level("ma");
  // There is one ball, which is alone.
  options.medial_symmetry.samples = 1;
  const Run run(geometry::capsule(0.02, 0.1), options);
  const PlannerResult result = run.plan();
  CHECK(result.stop == PlannerStop::Exhausted);
  CHECK(result.statistics.attempts == 0);
  CHECK(result.statistics.target_failures.at("no candidate") == 1);
}

TEST_CASE("GS without a sample in the cone of approach ends at once, and says why",
          "[grasp][planning_methods]") {
  PlannerOptions options = at_voxel_level("gs");
  options.approach_O = Vector3d::UnitZ();
  // The direction is between the normals of the facets.
  options.approach_angle = 1e-6;
  options.max_attempts = 1000;
  const Run run(geometry::ball(0.04), options);
  const PlannerResult result = run.plan();
  CHECK(result.stop == PlannerStop::Exhausted);
  CHECK(result.statistics.attempts == 0);
  CHECK(result.statistics.target_failures.at("no sample") == 1);
}

TEST_CASE("Attempts with a missing contact count where they are asked to",
          "[grasp][planning_methods]") {
  PlannerOptions options = at_voxel_level("gs");
  options.max_attempts = 120;
  options.count = 1000;
  options.distinct = {0.0, 0.0, 0.0};
  const Run measured(geometry::box(Vector3d(0.12, 0.05, 0.05)), options);
  options.missing_contact = grasp::MissingContact::Fails;
  const Run failing(geometry::box(Vector3d(0.12, 0.05, 0.05)), options);
  const PlannerResult all = measured.plan();
  const PlannerResult complete = failing.plan();
  std::set<std::int64_t> attempts_of_all;
  std::int64_t incomplete = 0;
  for (const Grasp& grasp : all.grasps) {
    attempts_of_all.insert(grasp.attempt);
    if (!grasp.has_all_contacts) ++incomplete;
  }
  CHECK(incomplete > 0);
  // Only those that miss a contact are new.
  CHECK(static_cast<std::int64_t>(all.grasps.size()) - incomplete ==
        static_cast<std::int64_t>(complete.grasps.size()));
  for (const Grasp& grasp : complete.grasps) {
    CHECK(grasp.has_all_contacts);
    CHECK(attempts_of_all.contains(grasp.attempt));
  }
}

TEST_CASE("Intermediate models are tables of points on or in the object",
          "[grasp][planning_methods]") {
  PlannerOptions options = at_voxel_level(some_method());
  INFO(options.planner);
  const Run run(geometry::torus(0.05, 0.018), options);
  const grasp::GuidanceModel model = grasp::guidance_model(run.object, run.hand, options);
  REQUIRE(model.rows.size() > 500);
  REQUIRE(model.columns.size() >= 6);
  CHECK(model.columns[0] == "x_m");
  CHECK(model.columns[1] == "y_m");
  CHECK(model.columns[2] == "z_m");
  for (const std::vector<double>& row : model.rows) {
    REQUIRE(row.size() == model.columns.size());
    const double distance = run.object.query.signed_distance(Vector3d(row[0], row[1], row[2]));
    if (model.columns[3] == "radius_m") {
      // Balls are empty to 5 % of their radius.
      CHECK(std::abs(distance + row[3]) <= 0.05 * row[3]);
    } else {
      CHECK(std::abs(distance) < 1e-9);
    }
  }
  // A header line and a line per point; numbers come back as they were.
  std::istringstream csv(grasp::to_csv(model));
  std::string line;
  std::getline(csv, line);
  CHECK(line.substr(0, 11) == "x_m,y_m,z_m");
  std::getline(csv, line);
  CHECK(std::stod(line) == model.rows[0][0]);
  const std::string ply = grasp::to_ply(model);
  CHECK(ply.find("element vertex " + std::to_string(model.rows.size())) != std::string::npos);
  CHECK(ply.find("property double z\n") != std::string::npos);
}

}  // namespace

}  // namespace test_planning_methods
