#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "grasp/planner_promises.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_measure.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "support/catch.hpp"

namespace test_planner_options {

namespace {

using namespace graspfit;
using namespace graspfit::testing;
using testing::Contains;

// The following tests are about options.

std::string message_of(const PlannerOptions& options) {
  try {
    options.validate();
  } catch (const base::InvalidInput& error) {
    return error.what();
  }
  return "nothing thrown";
}

template <typename Set>
std::string message_after(Set set) {
  PlannerOptions options;
  set(options);
  return message_of(options);
}

TEST_CASE("Planner options out of range are refused by name and value", "[grasp][grasp_planner]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(PlannerOptions{}.validate());
  CHECK(unsaid(message_after([](auto& o) { o.num_contacts = 1; }), "num_contacts", "1") == "");
  CHECK(unsaid(message_after([](auto& o) { o.count = 0; }), "count", "0") == "");
  CHECK(unsaid(message_after([](auto& o) { o.max_attempts = -4; }), "max_attempts", "-4") == "");
  CHECK(unsaid(message_after([](auto& o) { o.max_iterations = 0; }), "max_iterations", "0") == "");
  CHECK(unsaid(message_after([](auto& o) { o.approach_O = Vector3d(0, 0, 0); }), "approach_O",
               "0") == "");
  CHECK(unsaid(message_after([=](auto& o) { o.approach_O = Vector3d(0, nan, 1); }), "approach_O",
               "nan") == "");
  CHECK(unsaid(message_after([](auto& o) { o.wall_clock_limit_s = -2.5; }), "wall_clock_limit_s",
               "-2.5") == "");
  CHECK(unsaid(message_after([](auto& o) { o.resolution = 3; }), "resolution", "3") == "");
  CHECK(unsaid(message_after([](auto& o) { o.resolution = 513; }), "resolution", "513") == "");
  CHECK(unsaid(message_after([](auto& o) { o.clip_thickness = 0.0; }), "clip_thickness", "0") ==
        "");
  CHECK(unsaid(message_after([](auto& o) { o.self_overlap = -0.125; }), "self_overlap", "-0.125") ==
        "");
  // Refined grasps touch with every part, so that this needs grasps without refinement.
  const auto measured = [](auto& o) { o.missing_contact = grasp::MissingContact::Measured; };
  CHECK(unsaid(message_after(measured), "missing_contact", "refine") == "");
  CHECK(message_after([&](auto& o) {
          measured(o);
          o.refine = false;
        }) == "nothing thrown");
  CHECK(unsaid(message_after([](auto& o) { o.contact_score_threshold = 1.0; }),
               "contact_score_threshold", "1") == "");
  // These are options inside options.
  CHECK(unsaid(message_after([](auto& o) { o.sampling.count = 0; }), "count", "0") == "");
  CHECK(unsaid(message_after([](auto& o) { o.sampling.box_spacing = 0.0; }), "box_spacing", "0") ==
        "");
  CHECK(unsaid(message_after([=](auto& o) { o.sampling.largest_standoff = nan; }),
               "largest_standoff", "nan") == "");
  CHECK(unsaid(message_after([](auto& o) { o.medial_symmetry.samples = 0; }), "samples", "0") ==
        "");
  CHECK(unsaid(message_after([](auto& o) { o.medial_symmetry.rim_ratio = 0.005; }), "rim_ratio",
               "0.005") == "");
  CHECK(unsaid(message_after([](auto& o) { o.medial_symmetry.search_radius = -1.0; }),
               "search_radius", "-1") == "");
  CHECK(unsaid(message_after([](auto& o) { o.score.neighborhood = 4; }), "neighborhood", "4") ==
        "");
  CHECK(unsaid(message_after([](auto& o) { o.targets.score_threshold = 1.5; }), "score_threshold",
               "1.5") == "");
  // Grasp files say 0 where these are empty.
  CHECK(unsaid(message_after([](auto& o) { o.targets.min_separation = 0.0; }),
               "min_separation_m = 0", "") == "");
  CHECK(unsaid(message_after([](auto& o) { o.quality.merge_distance = 0.0; }),
               "merge_distance_m = 0", "") == "");
  CHECK(unsaid(message_after([](auto& o) { o.fitting.small_step = -0.5; }), "small_step", "-0.5") ==
        "");
  CHECK(unsaid(message_after([](auto& o) { o.quality.theta_max = 1.75; }), "theta_max", "1.75") ==
        "");
}

TEST_CASE("Planning checks its options before it works", "[grasp][grasp_planner]") {
  Run run(geometry::ball(0.05), {});
  run.options.count = 0;
  CHECK_THROWS_AS(run.plan(), base::InvalidInput);
  run.options = {};
  run.options.targets.max_seeds = 0;
  CHECK_THROWS_AS(run.plan(), base::InvalidInput);
  run.options = {};
  run.options.fingers = {"thumb", "finger_9"};
  CHECK_THROWS_WITH(run.plan(), Contains("finger_9") && Contains("finger_1"));
  run.options = {};
  run.options.num_contacts = 4;
  CHECK_THROWS_AS(run.plan(), base::InvalidInput);
  run.options = {};
  run.options.fingers = {"thumb"};  // At least 2 are needed.
  CHECK_THROWS_AS(run.plan(), base::InvalidInput);
  run.options = {};
  run.options.planner = "none";
  CHECK_THROWS_WITH(run.plan(), Contains("planner \"none\"") &&
                                    Contains("fitting|gs-targets|gs|ma|ma-full-retreat"));
}

TEST_CASE("The thumb comes first where it is among the fingers asked for",
          "[grasp][grasp_planner]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const int thumb = hand.thumb();
  const int finger_1 = hand.finger_index("finger_1"), finger_2 = hand.finger_index("finger_2");
  const auto requested = [&](std::vector<std::string> names) {
    PlannerOptions options;
    options.fingers = std::move(names);
    return grasp::requested_parts(hand, options).fingers;
  };
  CHECK(requested({"thumb", "finger_1", "finger_2"}) ==
        std::vector<int>{thumb, finger_1, finger_2});
  CHECK(requested({"finger_1", "finger_2", "thumb"}) ==
        std::vector<int>{thumb, finger_1, finger_2});
  CHECK(requested({"finger_2", "thumb"}) == std::vector<int>{thumb, finger_2});
  CHECK(requested({"finger_2", "finger_1"}) == std::vector<int>{finger_2, finger_1});

  PlannerOptions options;
  options.num_contacts = 3;
  const std::vector<int> three = grasp::requested_parts(hand, options).fingers;
  CHECK(three.size() == 3);
  CHECK(three.front() == thumb);
  CHECK(std::set<int>(three.begin(), three.end()).size() == 3);
  options.num_contacts = 2;
  const std::vector<int> two = grasp::requested_parts(hand, options).fingers;
  CHECK(two.size() == 2);
  CHECK(two.front() == thumb);
  CHECK(two.back() != thumb);

  options.num_contacts = 4;
  CHECK_THROWS_WITH(grasp::requested_parts(hand, options), Contains("4") && Contains("3"));
  CHECK_THROWS_AS(requested({"thumb", "thumb"}), base::InvalidInput);
  CHECK_THROWS_WITH(requested({"thumb", "pinky"}), Contains("pinky") && Contains("finger_2"));
}

TEST_CASE("A clip volume is half a voxel thick, a millimeter at least, or as asked for",
          "[grasp][grasp_planner]") {
  PlannerOptions options;
  CHECK(grasp::clip_thickness(options, 0.005) == Approx(0.0025).epsilon(1e-15));
  CHECK(grasp::clip_thickness(options, 0.0019) == 0.001);
  CHECK(grasp::clip_thickness(options, 0.0021) == Approx(0.00105).epsilon(1e-15));
  options.clip_thickness = 0.003;
  CHECK(grasp::clip_thickness(options, 0.02) == 0.003);
  CHECK(grasp::clip_thickness(options, 0.001) == 0.003);
}

TEST_CASE("The object is prepared with the resolution asked for alike for every hand",
          "[grasp][grasp_planner]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const geometry::TriangleMesh mesh = geometry::box(Vector3d(0.10, 0.06, 0.08));
  for (const int resolution : {12, 30}) {
    PlannerOptions options;
    options.resolution = resolution;
    const grasp::ObjectModel object = grasp::prepare_object(mesh, hand, options);
    const geometry::VoxelLattice& lattice = object.grid.lattice;
    CHECK(lattice.voxel_size == Approx(0.10 / resolution).epsilon(1e-12));
    CHECK(lattice.counts.x() == resolution + 2 * grasp::kMarginVoxels);
    const grasp::ObjectModel other =
        grasp::prepare_object(mesh, hands::find_hand("human_hand"), options);
    CHECK(other.grid.lattice == lattice);
    CHECK(other.distance.values == object.distance.values);
    CHECK(object.normalizing_radius ==
          Approx(0.5 * std::sqrt(0.01 + 0.0036 + 0.0064)).epsilon(1e-12));
    CHECK(object.mass.center_of_mass.norm() < 1e-12);
    CHECK(object.scores.scores.size() == object.patches.size());
  }
}

// The following tests are about measuring a configuration.

TEST_CASE("A hand far from the object has no contact, no measure and no penetration",
          "[grasp][grasp_planner]") {
  const Run run(geometry::ball(0.05), {});
  const grasp::SurroundingsCollision surroundings(run.hand, {});
  const grasp::MeasuringScene scene = measuring_scene(run, surroundings);
  hands::HandConfiguration configuration = hands::open_configuration(run.hand);
  const grasp::RequestedParts parts = grasp::requested_parts(run.hand, {});
  const auto measure_at = [&](const Vector3d& position) {
    configuration.X_OH.translation() = position;
    return grasp::measure_grasp(scene, configuration, parts);
  };
  const Grasp away = measure_at(Vector3d(0, 0, -1));
  CHECK(away.contacts.empty());
  CHECK(away.quality.m == 0.0);
  CHECK_FALSE(away.has_all_contacts);
  CHECK_FALSE(away.penetration.object_intersects);
  CHECK(away.penetration.object_depth == 0.0);
  CHECK_FALSE(away.is_valid());

  // The ball's center is in the palm's surface, so that half the ball is on the palm's side of it.
  const Grasp inside = measure_at(Vector3d(0, 0, 0));
  CHECK(inside.penetration.object_intersects);
  CHECK(inside.penetration.object_depth > 0.01);
  CHECK(inside.penetration.object_depth_bound >= inside.penetration.object_depth);
  CHECK_FALSE(inside.is_valid());
}

}  // namespace

}  // namespace test_planner_options
