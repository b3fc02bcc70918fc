#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "grasp/guidance_scene.hpp"
#include "grasp/target_scenes.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

namespace test_random_targets {

namespace {

using namespace graspfit;
using namespace graspfit::testing;
using grasp::PairRule;
using grasp::TargetFailure;

// The following tests are about chance.

/// Returns the relative errors of a third contact's two edges and its centroid distance, by which
/// it is ranked.
std::array<double, 3> errors_of_third(const grasp::ObjectModel& object,
                                      const grasp::TargetContacts& targets) {
  const Vector3d &v1 = targets.contacts[0].point_O, &v2 = targets.contacts[1].point_O,
                 &v3 = targets.contacts[2].point_O;
  const double edge = (v2 - v1).norm();
  return {std::abs((v3 - v1).norm() - edge) / edge, std::abs((v3 - v2).norm() - edge) / edge,
          ((v1 + v2 + v3) / 3.0 - object.mass.center_of_mass).norm()};
}

TEST_CASE("A pool of one takes a third contact that no other beats in every respect",
          "[grasp][target_contacts]") {
  TargetOptions options;
  options.pool_fraction = 1e-9;
  options.pool_minimum = 1;
  const PartDistances distances = equal_reach(3, 0.02, 0.30);
  const RequestedParts fingers = {{0, 1, 2}};
  for (const NamedMesh& shape : shapes()) {
    const grasp::ObjectModel object = object_of(shape.mesh);
    for (int seed = 1; seed <= 10; ++seed) {
      const TargetSelection selection = select(object, distances, fingers, options, seed);
      if (!selection.targets) continue;
      const auto chosen = errors_of_third(object, *selection.targets);
      grasp::TargetContacts other = *selection.targets;
      int num_better = 0;
      for (std::size_t patch = 0; patch < object.patches.size(); ++patch) {
        grasp::TargetContact& third = other.contacts[2];
        third.patch = static_cast<int>(patch);
        third.point_O = object.patches[patch].centroid;
        third.outward_normal_O = object.patches[patch].outward_normal;
        third.score = object.scores.scores[patch];
        const auto errors = errors_of_third(object, other);
        const bool is_better = errors[0] < chosen[0] - 1e-9 && errors[1] < chosen[1] - 1e-9 &&
                               errors[2] < chosen[2] - 1e-9;
        if (is_better && broken_requirements(object, distances, fingers, options, other).empty()) {
          ++num_better;
        }
      }
      INFO(shape.name << ", seed " << seed);
      CHECK(num_better == 0);
    }
  }
}

TEST_CASE("A pool of five takes each of three third contacts some time",
          "[grasp][target_contacts]") {
  // With the first two at 90° and 210°, the place at 330° completes an equilateral triangle around
  // the center of mass; those beside it are worse but feasible.
  const grasp::ObjectModel object = object_of(on_unit_circle({90, 210, 330, 342, 318}));
  TargetOptions options;
  options.pool_fraction = 1e-9;
  options.pool_minimum = 5;
  std::set<int> thirds;
  for (int seed = 1; seed <= 300; ++seed) {
    const std::vector<int> patches =
        patches_of(select(object, equal_reach(3, 0.01, 3.0), {{0, 1, 2}}, options, seed));
    if (patches.size() == 3 && patches[0] + patches[1] == 1) thirds.insert(patches[2]);
  }
  CHECK(thirds == std::set<int>{2, 3, 4});
}

TEST_CASE("Every feasible seed is chosen some time", "[grasp][target_contacts]") {
  std::vector<double> angles_deg;
  for (int i = 0; i < 12; ++i) angles_deg.push_back(30.0 * i);
  const grasp::ObjectModel object = object_of(on_unit_circle(angles_deg));
  std::vector<int> count(12, 0);
  constexpr int kDraws = 1200;
  for (int seed = 1; seed <= kDraws; ++seed) {
    ++count[patches_of(select(object, equal_reach(2, 0.01, 3.0), {{0, 1}}, {}, seed)).at(0)];
  }
  // The counts are uniform: 100 each with standard deviation 9.6; the bound is five of them.
  for (const int times : count) CHECK(std::abs(times - 100) < 48);
}

TEST_CASE("The same seed gives the same targets, other seeds give others",
          "[grasp][target_contacts]") {
  const grasp::ObjectModel object = object_of(geometry::torus(0.05, 0.018));
  const PartDistances distances = equal_reach(3, 0.02, 0.30);
  std::set<std::vector<int>> different;
  for (int seed = 1; seed <= 30; ++seed) {
    base::Random one(seed), two(seed);
    const auto draw = [&](base::Random& random) {
      return grasp::TargetSelector(object, distances, {{0, 1, 2}}, {}, grasp::IdealMeasure{})
          .select(random);
    };
    const TargetSelection a = draw(one);
    const TargetSelection b = draw(two);
    CHECK(patches_of(a) == patches_of(b));
    CHECK(a.seeds_tried == b.seeds_tried);
    // Both have drawn as many numbers.
    CHECK(one.next() == two.next());
    different.insert(patches_of(a));
  }
  CHECK(different.size() >= 25);
}
// The following tests are about failures.

TEST_CASE("No voxel above the threshold: no seed", "[grasp][target_contacts]") {
  const grasp::ObjectModel object = object_of(geometry::ball(0.05));
  const auto& scores = object.scores.scores;
  TargetOptions options;
  options.score_threshold = *std::max_element(scores.begin(), scores.end());
  // On a ball nothing reaches 1.25 times the median.
  REQUIRE(options.score_threshold < 1.0);
  const TargetSelection selection = select(object, equal_reach(3, 0, 1), {{0, 1, 2}}, options, 1);
  CHECK_FALSE(selection.targets);
  CHECK(selection.failure == TargetFailure::NoSeed);
}

TEST_CASE("An object wider than the fingers open: no second contact", "[grasp][target_contacts]") {
  // On a sphere a stable pair is more than 90° apart, so farther than sqrt(2) · 5 cm = 7.07 cm.
  // Normals of this icosphere's patches leave the radial direction by its faces' half width, 2.2°,
  // at most, which gives 2 · 5 cm · sin(45° − 2.2°) = 6.8 cm.
  const grasp::ObjectModel object = object_of(geometry::ball(0.05));
  for (const RequestedParts& fingers : {RequestedParts{{0, 1}}, RequestedParts{{0, 1, 2}}}) {
    const TargetSelection selection = select(object, equal_reach(3, 0.0, 0.067), fingers, {}, 1);
    CHECK_FALSE(selection.targets);
    CHECK(selection.failure == TargetFailure::NoSecond);
    CHECK(selection.seeds_tried == 200);
  }
}

TEST_CASE("An object smaller than the separation: no second contact", "[grasp][target_contacts]") {
  const grasp::ObjectModel object = object_of(geometry::ball(0.01));
  TargetOptions options;
  options.min_separation = 0.023;
  const TargetSelection selection =
      select(object, equal_reach(3, 0.0, 0.3), {{0, 1, 2}}, options, 1);
  CHECK_FALSE(selection.targets);
  CHECK(selection.failure == TargetFailure::NoSecond);
}

TEST_CASE("Room for two contacts but not for three: no further contact",
          "[grasp][target_contacts]") {
  // A ball holds three points at most sqrt(3) · r apart, but two at 2 r.
  const grasp::ObjectModel object = object_of(geometry::ball(0.05));
  TargetOptions options;
  options.min_separation = 0.09;
  const PartDistances distances = equal_reach(3, 0.0, 0.3);
  CHECK(select(object, distances, {{0, 1}}, options, 1).targets);
  const TargetSelection selection = select(object, distances, {{0, 1, 2}}, options, 1);
  CHECK_FALSE(selection.targets);
  CHECK(selection.failure == TargetFailure::NoFurther);
}

TEST_CASE("No more seeds are tried than allowed", "[grasp][target_contacts]") {
  const grasp::ObjectModel object = object_of(geometry::ball(0.05));
  for (const int max_seeds : {1, 7, 60}) {
    TargetOptions options;
    options.max_seeds = max_seeds;
    const TargetSelection selection =
        select(object, equal_reach(3, 0.0, 0.067), {{0, 1}}, options, 1);
    CHECK_FALSE(selection.targets);
    CHECK(selection.seeds_tried == max_seeds);
  }
}

TEST_CASE("A target selection without two fingers is refused", "[grasp][target_contacts]") {
  const grasp::ObjectModel object = object_of(geometry::ball(0.05));
  const PartDistances distances = equal_reach(3, 0.0, 0.3);
  CHECK_THROWS_AS(select(object, distances, {{}}, {}, 1), base::InvalidInput);
  CHECK_THROWS_AS(select(object, distances, {{0}}, {}, 1), base::InvalidInput);
}

TEST_CASE("Target options out of range are refused by name and value", "[grasp][target_contacts]") {
  const auto message_of = [](auto set) {
    TargetOptions options;
    set(options);
    try {
      options.validate();
    } catch (const base::InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(TargetOptions{}.validate());
  CHECK(unsaid(message_of([](auto& o) { o.score_threshold = -0.25; }), "score_threshold",
               "-0.25") == "");
  CHECK(unsaid(message_of([](auto& o) { o.score_threshold = 1.0; }), "score_threshold", "1") == "");
  CHECK(unsaid(message_of([=](auto& o) { o.score_threshold = nan; }), "score_threshold", "nan") ==
        "");
  CHECK(unsaid(message_of([](auto& o) { o.theta_max = 0.0; }), "theta_max", "0") == "");
  CHECK(unsaid(message_of([](auto& o) { o.theta_max = 1.75; }), "theta_max", "1.75") == "");
  CHECK(unsaid(message_of([=](auto& o) { o.theta_max = nan; }), "theta_max", "nan") == "");
  CHECK(unsaid(message_of([](auto& o) { o.edge_tolerance_rel = -0.5; }), "edge_tolerance_rel",
               "-0.5") == "");
  CHECK(unsaid(message_of([](auto& o) { o.centroid_limit_rel = -0.5; }), "centroid_limit_rel",
               "-0.5") == "");
  CHECK(unsaid(message_of([](auto& o) { o.pool_fraction = 0.0; }), "pool_fraction", "0") == "");
  CHECK(unsaid(message_of([](auto& o) { o.pool_fraction = 1.5; }), "pool_fraction", "1.5") == "");
  CHECK(unsaid(message_of([](auto& o) { o.pool_minimum = 0; }), "pool_minimum", "0") == "");
  CHECK(unsaid(message_of([](auto& o) { o.max_seeds = 0; }), "max_seeds", "0") == "");
  CHECK(unsaid(message_of([](auto& o) { o.relax_after_seeds = -3; }), "relax_after_seeds", "-3") ==
        "");
  CHECK(unsaid(message_of([](auto& o) { o.min_separation = -0.125; }), "min_separation",
               "-0.125") == "");
}

TEST_CASE("The centroid of targets is the midpoint, the triangle's centroid, the mean of more",
          "[grasp][target_contacts]") {
  grasp::TargetContacts targets;
  const auto add = [&](double x, double y, double z) {
    targets.contacts.emplace_back();
    targets.contacts.back().point_O = Vector3d(x, y, z);
  };
  add(1, 0, 0);
  add(3, 2, 0);
  CHECK((targets.centroid() - Vector3d(2, 1, 0)).norm() < 1e-15);
  add(2, 4, 6);
  CHECK((targets.centroid() - Vector3d(2, 2, 2)).norm() < 1e-15);
  add(2, 2, 6);
  CHECK((targets.centroid() - Vector3d(2, 2, 3)).norm() < 1e-15);
}

TEST_CASE("A target for another pad than its fingertip's is met by that pad",
          "[grasp][target_contacts]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const int other = hand.pad_index("finger_1_proximal_pad");
  grasp::TargetContacts targets;
  targets.contacts.resize(3);
  targets.contacts[0].finger = hand.thumb();
  targets.contacts[1].finger = hand.finger_index("finger_1");
  targets.contacts[1].pad = other;
  targets.contacts[2].is_palm = true;
  const std::vector<int> pads = {*hand.fingers[hand.thumb()].tip_pad, other, *hand.palm.pad};
  for (std::size_t i = 0; i < pads.size(); ++i) {
    CHECK(grasp::pad_for(hand, targets.contacts[i]) == pads[i]);
  }
  const grasp::RequestedParts parts = grasp::parts_of(targets);
  CHECK(parts.size() == 3);
  CHECK(grasp::requested_pads(hand, parts) == pads);
  CHECK(grasp::contacts_at(targets)[1].pad == other);
}

TEST_CASE("Parts and pads that a hand does not have are refused", "[grasp][target_contacts]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const auto message = [&](const grasp::RequestedParts& parts, const hands::HandModel& of) {
    try {
      grasp::requested_pads(of, parts);
    } catch (const base::InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  CHECK(message({{7}}, hand) == "finger 7 of hand barrett, which has 3");
  CHECK(message({{0, 1}, false, {99}}, hand) ==
        "pad 99 of hand barrett, which has " + std::to_string(hand.pads.size()));
  const int palm = *hand.palm.pad;
  CHECK(message({{0, 1}, false, {palm}}, hand) ==
        "pad " + hand.pads[palm].name + " is of no requested finger");
  hands::HandModel bare = hand;
  bare.palm.pad.reset();
  bare.fingers[1].tip_pad.reset();
  CHECK(message({{0}, true}, bare) == "the palm of hand barrett has no pad");
  CHECK(message({{0, 1}}, bare) ==
        "finger " + hand.fingers[1].name + " of hand barrett has no fingertip pad");
  grasp::TargetContact target;
  target.finger = -1;
  CHECK_THROWS_AS(grasp::pad_for(hand, target), base::InvalidInput);
  target = {};
  target.is_palm = true;
  CHECK_THROWS_AS(grasp::pad_for(bare, target), base::InvalidInput);
}

/// Returns where the first targets of attempts 0 to 19 are with the paper's method.
std::vector<Vector3d> first_seeds(const grasp::PlannerOptions& options) {
  const Guided guided(geometry::torus(0.05, 0.02), options);
  std::vector<Vector3d> seeds;
  for (int number = 0; number < 20; ++number) {
    const grasp::GuidedStarts starts = guided.guidance->starts(number);
    if (!starts.starts.empty()) {
      seeds.push_back(starts.starts.front().targets.contacts.front().point_O);
    }
  }
  return seeds;
}

TEST_CASE("The ideal M that sets are preferred by is that of the planner's measure",
          "[grasp][target_contacts]") {
  grasp::PlannerOptions options = at_voxel_level("fitting");
  options.target_draws = 1;
  options.targets.ideal_m_bias = 8.0;
  const std::vector<Vector3d> by_m = first_seeds(options);
  REQUIRE(by_m.size() >= 10);
  // A bias as small as this one prefers no set.
  options.targets.ideal_m_bias = 1e-300;
  const std::vector<Vector3d> by_chance = first_seeds(options);
  CHECK(by_m != by_chance);
  // A measure that is 1 for every set, M1^0 M2^0 M3^0, prefers none either.
  options.targets.ideal_m_bias = 8.0;
  options.quality.w1 = options.quality.w2 = options.quality.w3 = 0.0;
  CHECK(first_seeds(options) == by_chance);
}

}  // namespace

}  // namespace test_random_targets
