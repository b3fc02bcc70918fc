#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include "grasp/target_scenes.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/mesh_repair.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"
#include "support/test_data.hpp"

namespace test_target_contacts {

namespace {

using namespace graspfit;
using namespace graspfit::testing;
using grasp::PairRule;
using grasp::TargetFailure;

constexpr double kPi = std::numbers::pi;

// The following tests check the requirements of section 6 of the paper on real shapes.

TEST_CASE("Every target set of three meets every requirement of section 6 on every shape",
          "[grasp][target_contacts]") {
  const RequestedParts fingers = {{2, 0, 1}};
  const PartDistances distances = equal_reach(3, 0.02, 0.30);
  for (const NamedMesh& shape : shapes()) {
    const grasp::ObjectModel object = object_of(shape.mesh);
    for (const PairRule rule : {PairRule::Seed, PairRule::AllPairs}) {
      INFO(shape.name << (rule == PairRule::Seed ? ", pairs with the seed" : ", all pairs"));
      TargetOptions options;
      options.pair_rule = rule;
      options.min_separation = 0.023;
      // The faces of a box hold no three points that are pairwise in each other's cones, as two
      // would be on one face. Little is found, after all seeds.
      const bool is_hopeless = shape.name == "box" && rule == PairRule::AllPairs;
      const int num_sets =
          check_selections(object, distances, fingers, options, is_hopeless ? 2 : 40);
      CHECK(num_sets >= (is_hopeless ? 0 : 30));
    }
  }
}

TEST_CASE("Every pair of targets meets the three requirements of a second contact",
          "[grasp][target_contacts]") {
  const PartDistances distances = equal_reach(3, 0.02, 0.30);
  for (const NamedMesh& shape : shapes()) {
    const grasp::ObjectModel object = object_of(shape.mesh);
    INFO(shape.name);
    CHECK(check_selections(object, distances, {{2, 0}}, {}, 40) == 40);
  }
}

TEST_CASE("Other thresholds, cones, limits and separations are obeyed as given",
          "[grasp][target_contacts]") {
  const grasp::ObjectModel object = object_of(geometry::capsule(0.03, 0.08));
  const PartDistances distances = equal_reach(3, 0.01, 0.12);
  const RequestedParts fingers = {{0, 1, 2}};
  TargetOptions options;
  SECTION("high threshold") { options.score_threshold = 0.8; }
  SECTION("narrow cones") { options.theta_max = 35.0 * kPi / 180.0; }
  SECTION("edges within a twentieth") { options.edge_tolerance_rel = 0.05; }
  SECTION("centroid within a tenth") { options.centroid_limit_rel = 0.1; }
  SECTION("separation of 4.5 cm") { options.min_separation = 0.045; }
  SECTION("limits relaxed from the third seed on") {
    options.edge_tolerance_rel = 0.02;
    options.centroid_limit_rel = 0.05;
    options.relax_after_seeds = 2;
  }
  SECTION("the single best candidate each time") {
    options.pool_fraction = 1e-9;
    options.pool_minimum = 1;
  }
  CHECK(check_selections(object, distances, fingers, options, 60) >= 20);
}

TEST_CASE("Targets of the Barrett hand on the bunny meet every requirement",
          "[grasp][target_contacts]") {
  const auto file = testing::packaged_mesh("bunny00.off");
  if (!file) GRASPFIT_SKIP_TEST("bunny00.off of libcgal-demo is not unpacked; run ./quickstart");
  const geometry::TriangleMesh read = geometry::repair_mesh(geometry::read_mesh(*file).mesh).mesh;
  const hands::HandModel hand = hands::find_hand("barrett");
  const PartDistances distances = grasp::part_distances(hand);
  const RequestedParts fingers = {
      {hand.thumb(), hand.finger_index("finger_1"), hand.finger_index("finger_2")}};
  for (const double longest : {0.09, 0.15, 0.30}) {
    const grasp::ObjectModel object =
        object_of(geometry::scaled(read, longest / geometry::longest_extent(read)));
    INFO("longest extent " << longest);
    TargetOptions options;
    options.min_separation = 0.023;
    CHECK(check_selections(object, distances, fingers, options, 20) >= 15);
  }
}

TEST_CASE("Distances are those of the fingers served, not of all fingers",
          "[grasp][target_contacts]") {
  // Finger 3 could reach anything; it is not among the fingers asked for. Of the others, one target
  // has to be 4–6 cm from the seed's and one 7–9.5 cm, across a box of 5.7 cm, whatever their
  // order.
  PartDistances distances = equal_reach(4, 0.001, 1.0);
  set_range(distances, 0, 1, {0.040, 0.060});
  set_range(distances, 0, 2, {0.070, 0.095});
  set_range(distances, 1, 2, {0.030, 0.095});
  const grasp::ObjectModel object = object_of(geometry::box(Vector3d(0.057, 0.085, 0.12)));
  TargetOptions options;
  options.edge_tolerance_rel = 1.0;
  const int num_sets = check_selections(object, distances, {{0, 1, 2}}, options, 60);
  CHECK(num_sets >= 20);
  CHECK(check_selections(object, distances, {{0, 2}}, options, 30) >= 20);
}
// The following tests are about limits, one at a time, on objects of a few places.

TEST_CASE("Only places whose score exceeds the threshold are targets", "[grasp][target_contacts]") {
  // There are two opposite pairs; the places of the second are at the threshold or have no normal.
  std::vector<Place> places = on_unit_circle({0, 180, 90, 270});
  const PartDistances distances = equal_reach(2, 0.1, 3.0);
  SECTION("at the threshold") {
    places[2].score = 0.6;
    places[3].score = 0.6;
  }
  SECTION("below the threshold") {
    places[2].score = 0.6 - 1e-15;
    places[3].score = 0.0;
  }
  SECTION("without a normal") {
    places[2].has_normal = false;
    places[3].has_normal = false;
  }
  const grasp::ObjectModel object = object_of(places);
  for (int seed = 1; seed <= 30; ++seed) {
    const std::vector<int> patches = patches_of(select(object, distances, {{0, 1}}, {}, seed));
    CHECK((patches == std::vector<int>{0, 1} || patches == std::vector<int>{1, 0}));
  }
}

TEST_CASE("A partner must lie in both friction cones, each strictly within theta_max",
          "[grasp][target_contacts]") {
  const PartDistances distances = equal_reach(2, 0.1, 3.0);
  const TargetOptions options;
  for (const int tilted : {0, 1}) {
    // 1e-9 rad is far above the rounding of an angle and far below what a grasp could notice.
    for (const double beyond : {-1e-9, 1e-9}) {
      const double tilt = options.theta_max + beyond;
      std::vector<Place> places = on_unit_circle({0, 180});
      Vector3d& normal = places[tilted].outward_normal;
      normal = Vector3d(std::cos(tilt) * normal.x(), 0.0, std::sin(tilt));
      const grasp::ObjectModel object = object_of(places);
      INFO("normal " << tilted << " tilted by theta_max + " << beyond);
      for (int seed = 1; seed <= 10; ++seed) {
        const TargetSelection selection = select(object, distances, {{0, 1}}, options, seed);
        CHECK(selection.targets.has_value() == (beyond < 0.0));
        if (!selection.targets) CHECK(selection.failure == TargetFailure::NoSecond);
      }
    }
  }
}

TEST_CASE("Normals that face each other across a gap form no pair", "[grasp][target_contacts]") {
  // These are the walls of a hole: lines are along the normals, but fingers inside would push
  // outward.
  std::vector<Place> places = on_unit_circle({0, 180});
  for (Place& place : places) place.outward_normal = -place.outward_normal;
  const TargetSelection selection =
      select(object_of(places), equal_reach(2, 0.1, 3.0), {{0, 1}}, {}, 1);
  CHECK_FALSE(selection.targets);
  CHECK(selection.failure == TargetFailure::NoSecond);
}

TEST_CASE("A partner must be in tip distance", "[grasp][target_contacts]") {
  // They are 2 m apart.
  const grasp::ObjectModel object = object_of(on_unit_circle({0, 180}));
  CHECK(select(object, equal_reach(2, 0.1, 2.0 + 1e-9), {{0, 1}}, {}, 1).targets);
  CHECK(select(object, equal_reach(2, 2.0 - 1e-9, 3.0), {{0, 1}}, {}, 1).targets);
  for (const auto& distances : {equal_reach(2, 0.1, 2.0 - 1e-9), equal_reach(2, 2.0 + 1e-9, 3.0)}) {
    const TargetSelection selection = select(object, distances, {{0, 1}}, {}, 1);
    CHECK_FALSE(selection.targets);
    CHECK(selection.failure == TargetFailure::NoSecond);
  }
}

TEST_CASE("Targets keep their least separation", "[grasp][target_contacts]") {
  const PartDistances distances = equal_reach(3, 0.01, 3.0);
  TargetOptions options;
  SECTION("two") {
    const grasp::ObjectModel object = object_of(on_unit_circle({0, 180}));
    options.min_separation = 2.0 - 1e-9;
    CHECK(select(object, distances, {{0, 1}}, options, 1).targets);
    options.min_separation = 2.0 + 1e-9;
    const TargetSelection selection = select(object, distances, {{0, 1}}, options, 1);
    CHECK_FALSE(selection.targets);
    CHECK(selection.failure == TargetFailure::NoSecond);
  }
  SECTION("the second and the third, which need not be a stable pair") {
    // The seed is at 0°, the others are 2 · 20° apart on the far side, with 2 sin 20° between them.
    const grasp::ObjectModel object = object_of(on_unit_circle({0, 160, 200}));
    options.edge_tolerance_rel = 1.0;
    const double between = 2.0 * std::sin(20.0 * kPi / 180.0);
    options.min_separation = between - 1e-9;
    CHECK(select(object, distances, {{0, 1, 2}}, options, 1).targets);
    options.min_separation = between + 1e-9;
    const TargetSelection selection = select(object, distances, {{0, 1, 2}}, options, 1);
    CHECK_FALSE(selection.targets);
    CHECK(selection.failure == TargetFailure::NoFurther);
  }
}

/// Returns an isosceles triangle on the unit circle whose base is `ratio` < 1 of its legs. Its best
/// order has a leg as |V1V2| and edge error 1 − ratio; with the base as |V1V2| the error 1/ratio −
/// 1 is larger.
std::vector<Place> isosceles(double ratio) {
  const double half_apex_deg = std::asin(0.5 * ratio) * 180.0 / kPi;
  return on_unit_circle({0.0, 180.0 - 2.0 * half_apex_deg, 180.0 + 2.0 * half_apex_deg});
}

TEST_CASE(
    "Edges of the target triangle agree within the tolerance, and 1.5 times it after 50 seeds",
    "[grasp][target_contacts]") {
  const PartDistances distances = equal_reach(3, 0.01, 3.0);
  TargetOptions options;
  options.centroid_limit_rel = 10.0;
  const auto select_from = [&](double ratio, std::uint64_t seed) {
    return select(object_of(isosceles(ratio)), distances, {{0, 1, 2}}, options, seed);
  };
  for (int seed = 1; seed <= 10; ++seed) {
    const TargetSelection within = select_from(0.75 + 1e-9, seed);
    REQUIRE(within.targets);
    CHECK(within.seeds_tried <= 50);

    for (const double ratio : {0.75 - 1e-9, 1.0 - 0.375 + 1e-9}) {
      const TargetSelection relaxed = select_from(ratio, seed);
      REQUIRE(relaxed.targets);
      CHECK(relaxed.seeds_tried > 50);
    }
    const TargetSelection beyond = select_from(1.0 - 0.375 - 1e-9, seed);
    CHECK_FALSE(beyond.targets);
    CHECK(beyond.failure == TargetFailure::NoFurther);
  }
}

TEST_CASE("The target triangle's centroid is near the center of mass, relaxed after 50 seeds",
          "[grasp][target_contacts]") {
  const PartDistances distances = equal_reach(3, 0.01, 3.0);
  // The centroid is at the origin.
  grasp::ObjectModel object = object_of(on_unit_circle({0, 120, 240}));
  object.normalizing_radius = 1.25;
  const auto select_at = [&](double scaled_distance, std::uint64_t seed) {
    object.mass.center_of_mass = Vector3d(0, 0, scaled_distance * object.normalizing_radius);
    return select(object, distances, {{0, 1, 2}}, {}, seed);
  };
  for (int seed = 1; seed <= 10; ++seed) {
    const TargetSelection within = select_at(0.6 - 1e-9, seed);
    REQUIRE(within.targets);
    CHECK(within.seeds_tried == 1);  // Any seed will do.
    for (const double distance : {0.6 + 1e-9, 0.9 - 1e-9}) {
      const TargetSelection relaxed = select_at(distance, seed);
      REQUIRE(relaxed.targets);
      CHECK(relaxed.seeds_tried == 51);  // It is the first seed after fifty failed ones.
    }
    const TargetSelection beyond = select_at(0.9 + 1e-9, seed);
    CHECK_FALSE(beyond.targets);
    CHECK(beyond.failure == TargetFailure::NoFurther);
  }
}

TEST_CASE("A third contact pairs with the seed, or with both where all pairs are asked for",
          "[grasp][target_contacts]") {
  // On a circle two places form a stable pair if they are more than 90° apart. Here the two far
  // ones are 80° apart: pairs with the seed exist, all pairs do not.
  const PartDistances distances = equal_reach(3, 0.01, 3.0);
  const grasp::ObjectModel object = object_of(on_unit_circle({0, 140, 220}));
  TargetOptions options;
  options.edge_tolerance_rel = 1.0;
  for (int seed = 1; seed <= 10; ++seed) {
    options.pair_rule = PairRule::Seed;
    const std::vector<int> patches =
        patches_of(select(object, distances, {{0, 1, 2}}, options, seed));
    REQUIRE(patches.size() == 3);
    CHECK(patches[0] == 0);  // No other place has two partners.
    options.pair_rule = PairRule::AllPairs;
    const TargetSelection all = select(object, distances, {{0, 1, 2}}, options, seed);
    CHECK_FALSE(all.targets);
    CHECK(all.failure == TargetFailure::NoFurther);
  }
}

}  // namespace

}  // namespace test_target_contacts
