#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "grasp/target_oracle.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"
#include "support/test_data.hpp"

namespace {

using namespace graspfit;
using Eigen::Vector3d;
using grasp::PairRule;
using grasp::TargetFailure;
using grasp::TargetOptions;
using grasp::TargetSelection;
using hands::DistanceRange;
using hands::TipDistances;
using testing::broken_requirements;
using testing::unsaid;

const std::vector<std::string> kNothing;
constexpr double kPi = std::numbers::pi;

/// Fingers whose every pair reaches the same distances.
TipDistances equal_reach(int num_fingers, double smallest, double largest) {
  TipDistances distances(num_fingers, std::vector<DistanceRange>(num_fingers));
  for (int a = 0; a < num_fingers; ++a) {
    for (int b = 0; b < num_fingers; ++b) {
      if (a != b) distances[a][b] = {smallest, largest};
    }
  }
  return distances;
}

void set_range(TipDistances& distances, int a, int b, DistanceRange range) {
  distances[a][b] = range;
  distances[b][a] = range;
}

grasp::ObjectModel object_of(const geometry::TriangleMesh& mesh) {
  // The selection looks at the object alone: no room for a hand around it, so that building is
  // fast.
  grasp::ObjectModelOptions options;
  options.margin = 0.0;
  return grasp::build_object_model(mesh, options);
}

/// A place that may be chosen, for objects made of nothing but such places.
struct Place {
  Vector3d point;
  Vector3d outward_normal;
  double score = 0.9;
  bool has_normal = true;
};

/// An object whose patches are exactly `places`: what is selected from it can be worked out by
/// hand. Its mesh, a box that holds the places, plays no part. Center of mass at the origin,
/// radius 1.
grasp::ObjectModel object_of(const std::vector<Place>& places) {
  grasp::ObjectModel object = object_of(geometry::box(Vector3d(4, 4, 4)));
  object.mass.center_of_mass = Vector3d::Zero();
  object.normalizing_radius = 1.0;
  object.patches.clear();
  std::fill(object.patch_of_voxel.begin(), object.patch_of_voxel.end(), -1);
  object.scores = {};
  for (const Place& place : places) {
    geometry::SurfacePatch patch;
    patch.voxel = object.grid.lattice.index(object.grid.lattice.voxel_at(place.point));
    patch.area = 1e-4;
    patch.centroid = place.point;
    patch.outward_normal =
        place.has_normal ? place.outward_normal.normalized() : Vector3d(Vector3d::Zero());
    patch.has_normal = place.has_normal;
    object.patch_of_voxel[patch.voxel] = static_cast<int>(object.patches.size());
    object.patches.push_back(patch);
    object.scores.scores.push_back(place.score);
    object.scores.mean_plane_distance.push_back(0.0);
    object.scores.mean_normal_angle_deg.push_back(0.0);
  }
  return object;
}

/// Places on the unit circle at the given angles [deg], normals radial.
std::vector<Place> on_unit_circle(const std::vector<double>& angles_deg) {
  std::vector<Place> places;
  for (const double angle_deg : angles_deg) {
    const double angle = angle_deg * kPi / 180.0;
    const Vector3d radial(std::cos(angle), std::sin(angle), 0.0);
    places.push_back({radial, radial});
  }
  return places;
}

TargetSelection select(const grasp::ObjectModel& object, const TipDistances& distances,
                       const std::vector<int>& fingers, const TargetOptions& options,
                       std::uint64_t seed) {
  geometry::Random random(seed);
  return grasp::select_target_contacts(object, distances, fingers, options, random);
}

std::vector<int> patches_of(const TargetSelection& selection) {
  std::vector<int> patches;
  if (!selection.targets) return patches;
  for (const auto& target : selection.targets->contacts) patches.push_back(target.patch);
  return patches;
}

/// Selects with many seeds and checks every set, including that its points lie on the surface.
/// Returns the number of sets.
int check_selections(const grasp::ObjectModel& object, const TipDistances& distances,
                     const std::vector<int>& fingers, const TargetOptions& options, int num_seeds) {
  int num_sets = 0;
  for (int seed = 1; seed <= num_seeds; ++seed) {
    const TargetSelection selection = select(object, distances, fingers, options, seed);
    CHECK(selection.seeds_tried <= options.max_seeds);
    if (!selection.targets) continue;
    ++num_sets;
    INFO("seed " << seed);
    CHECK(selection.targets->seeds_tried == selection.seeds_tried);
    CHECK(broken_requirements(object, distances, fingers, options, *selection.targets) == kNothing);
    for (const auto& target : selection.targets->contacts) {
      // Rounding of a point that was projected to the surface: some 1e-16 of its coordinates.
      const double limit = 1e-14 * geometry::longest_extent(object.mesh());
      CHECK(std::sqrt(object.query.closest_point(target.point_O).squared_distance) <= limit);
    }
  }
  return num_sets;
}

struct NamedMesh {
  std::string name;
  geometry::TriangleMesh mesh;
};

std::vector<NamedMesh> shapes() {
  return {{"ball", geometry::ball(0.05)},
          {"box", geometry::box(Vector3d(0.10, 0.06, 0.08))},
          {"torus", geometry::torus(0.05, 0.018)},
          {"capsule", geometry::capsule(0.03, 0.08)}};
}

// ---------------------------------------------------------------------------------------------
// Requirements of section 6 on real shapes

TEST_CASE("Every target set of three meets every requirement of section 6 on every shape",
          "[grasp][target_contacts]") {
  const std::vector<int> fingers = {2, 0, 1};
  const TipDistances distances = equal_reach(3, 0.02, 0.30);
  for (const NamedMesh& shape : shapes()) {
    const grasp::ObjectModel object = object_of(shape.mesh);
    for (const PairRule rule : {PairRule::Seed, PairRule::AllPairs}) {
      INFO(shape.name << (rule == PairRule::Seed ? ", pairs with the seed" : ", all pairs"));
      TargetOptions options;
      options.pair_rule = rule;
      options.min_separation = 0.023;
      // The faces of a box hold no three points that are pairwise in each other's cones: two would
      // be on one face. Little is found, after all seeds.
      const bool is_hopeless = shape.name == "box" && rule == PairRule::AllPairs;
      const int num_sets =
          check_selections(object, distances, fingers, options, is_hopeless ? 2 : 40);
      CHECK(num_sets >= (is_hopeless ? 0 : 30));
    }
  }
}

TEST_CASE("Every pair of targets meets the three requirements of a second contact",
          "[grasp][target_contacts]") {
  const TipDistances distances = equal_reach(3, 0.02, 0.30);
  for (const NamedMesh& shape : shapes()) {
    const grasp::ObjectModel object = object_of(shape.mesh);
    INFO(shape.name);
    CHECK(check_selections(object, distances, {2, 0}, {}, 40) == 40);
  }
}

TEST_CASE("Other thresholds, cones, limits and separations are obeyed as given",
          "[grasp][target_contacts]") {
  const grasp::ObjectModel object = object_of(geometry::capsule(0.03, 0.08));
  const TipDistances distances = equal_reach(3, 0.01, 0.12);
  const std::vector<int> fingers = {0, 1, 2};
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
  const TipDistances distances = hands::tip_distances(hand);
  const std::vector<int> fingers = {hand.thumb(), hand.finger_index("finger_1"),
                                    hand.finger_index("finger_2")};
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
  // Finger 3 could reach anything; it is not among the fingers served. Fingers 0 and 1, 0 and 2
  // reach 4–6 cm and 8–9.5 cm: with the gap between, so the union is not the hull.
  TipDistances distances = equal_reach(4, 0.001, 1.0);
  set_range(distances, 0, 1, {0.040, 0.060});
  set_range(distances, 0, 2, {0.080, 0.095});
  set_range(distances, 1, 2, {0.030, 0.095});
  const grasp::ObjectModel object = object_of(geometry::box(Vector3d(0.05, 0.085, 0.12)));
  TargetOptions options;
  options.edge_tolerance_rel = 1.0;
  const int num_sets = check_selections(object, distances, {0, 1, 2}, options, 60);
  CHECK(num_sets >= 20);
  CHECK(check_selections(object, distances, {0, 2}, options, 30) >= 20);
}

// ---------------------------------------------------------------------------------------------
// Limits, one at a time, on objects of a few places (boundary band)

TEST_CASE("Only places whose score exceeds the threshold are targets", "[grasp][target_contacts]") {
  // Two opposite pairs; those of the second pair are at the threshold or have no normal.
  std::vector<Place> places = on_unit_circle({0, 180, 90, 270});
  const TipDistances distances = equal_reach(2, 0.1, 3.0);
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
    const std::vector<int> patches = patches_of(select(object, distances, {0, 1}, {}, seed));
    CHECK((patches == std::vector<int>{0, 1} || patches == std::vector<int>{1, 0}));
  }
}

TEST_CASE("A partner must lie in both friction cones, each strictly within theta_max",
          "[grasp][target_contacts]") {
  const TipDistances distances = equal_reach(2, 0.1, 3.0);
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
        const TargetSelection selection = select(object, distances, {0, 1}, options, seed);
        CHECK(selection.targets.has_value() == (beyond < 0.0));
        if (!selection.targets) CHECK(selection.failure == TargetFailure::NoSecond);
      }
    }
  }
}

TEST_CASE("Normals that face each other across a gap form no pair", "[grasp][target_contacts]") {
  // The walls of a hole: lines along the normals, but fingers inside would push outward.
  std::vector<Place> places = on_unit_circle({0, 180});
  for (Place& place : places) place.outward_normal = -place.outward_normal;
  const TargetSelection selection =
      select(object_of(places), equal_reach(2, 0.1, 3.0), {0, 1}, {}, 1);
  CHECK_FALSE(selection.targets);
  CHECK(selection.failure == TargetFailure::NoSecond);
}

TEST_CASE("A partner must be in tip distance", "[grasp][target_contacts]") {
  const grasp::ObjectModel object = object_of(on_unit_circle({0, 180}));  // 2 m apart
  CHECK(select(object, equal_reach(2, 0.1, 2.0 + 1e-9), {0, 1}, {}, 1).targets);
  CHECK(select(object, equal_reach(2, 2.0 - 1e-9, 3.0), {0, 1}, {}, 1).targets);
  for (const auto& distances : {equal_reach(2, 0.1, 2.0 - 1e-9), equal_reach(2, 2.0 + 1e-9, 3.0)}) {
    const TargetSelection selection = select(object, distances, {0, 1}, {}, 1);
    CHECK_FALSE(selection.targets);
    CHECK(selection.failure == TargetFailure::NoSecond);
  }
}

TEST_CASE("Targets keep their least separation", "[grasp][target_contacts]") {
  const TipDistances distances = equal_reach(3, 0.01, 3.0);
  TargetOptions options;
  SECTION("two") {
    const grasp::ObjectModel object = object_of(on_unit_circle({0, 180}));
    options.min_separation = 2.0 - 1e-9;
    CHECK(select(object, distances, {0, 1}, options, 1).targets);
    options.min_separation = 2.0 + 1e-9;
    const TargetSelection selection = select(object, distances, {0, 1}, options, 1);
    CHECK_FALSE(selection.targets);
    CHECK(selection.failure == TargetFailure::NoSecond);
  }
  SECTION("the second and the third, which need not be a stable pair") {
    // Seed at 0°, the others 2 · 20° apart on the far side: 2 sin 20° between them.
    const grasp::ObjectModel object = object_of(on_unit_circle({0, 160, 200}));
    options.edge_tolerance_rel = 1.0;
    const double between = 2.0 * std::sin(20.0 * kPi / 180.0);
    options.min_separation = between - 1e-9;
    CHECK(select(object, distances, {0, 1, 2}, options, 1).targets);
    options.min_separation = between + 1e-9;
    const TargetSelection selection = select(object, distances, {0, 1, 2}, options, 1);
    CHECK_FALSE(selection.targets);
    CHECK(selection.failure == TargetFailure::NoFurther);
  }
}

/// An isosceles triangle on the unit circle whose base is `ratio` < 1 of its legs. Its best order
/// has a leg as |V1V2| and edge error 1 − ratio; with the base as |V1V2| the error 1/ratio − 1 is
/// larger.
std::vector<Place> isosceles(double ratio) {
  const double half_apex_deg = std::asin(0.5 * ratio) * 180.0 / kPi;
  return on_unit_circle({0.0, 180.0 - 2.0 * half_apex_deg, 180.0 + 2.0 * half_apex_deg});
}

TEST_CASE(
    "Edges of the target triangle agree within the tolerance, and 1.5 times it after 50 seeds",
    "[grasp][target_contacts]") {
  const TipDistances distances = equal_reach(3, 0.01, 3.0);
  TargetOptions options;
  options.centroid_limit_rel = 10.0;
  const auto select_from = [&](double ratio, std::uint64_t seed) {
    return select(object_of(isosceles(ratio)), distances, {0, 1, 2}, options, seed);
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
  const TipDistances distances = equal_reach(3, 0.01, 3.0);
  grasp::ObjectModel object = object_of(on_unit_circle({0, 120, 240}));  // centroid at the origin
  object.normalizing_radius = 1.25;
  const auto select_at = [&](double scaled_distance, std::uint64_t seed) {
    object.mass.center_of_mass = Vector3d(0, 0, scaled_distance * object.normalizing_radius);
    return select(object, distances, {0, 1, 2}, {}, seed);
  };
  for (int seed = 1; seed <= 10; ++seed) {
    const TargetSelection within = select_at(0.6 - 1e-9, seed);
    REQUIRE(within.targets);
    CHECK(within.seeds_tried == 1);  // any seed will do
    for (const double distance : {0.6 + 1e-9, 0.9 - 1e-9}) {
      const TargetSelection relaxed = select_at(distance, seed);
      REQUIRE(relaxed.targets);
      CHECK(relaxed.seeds_tried == 51);  // the first seed after fifty failed ones
    }
    const TargetSelection beyond = select_at(0.9 + 1e-9, seed);
    CHECK_FALSE(beyond.targets);
    CHECK(beyond.failure == TargetFailure::NoFurther);
  }
}

TEST_CASE("A third contact pairs with the seed, or with both where all pairs are asked for",
          "[grasp][target_contacts]") {
  // On a circle two places form a stable pair if more than 90° apart. Here the two far ones are 80°
  // apart: pairs with the seed exist, all pairs do not.
  const TipDistances distances = equal_reach(3, 0.01, 3.0);
  const grasp::ObjectModel object = object_of(on_unit_circle({0, 140, 220}));
  TargetOptions options;
  options.edge_tolerance_rel = 1.0;
  for (int seed = 1; seed <= 10; ++seed) {
    options.pair_rule = PairRule::Seed;
    const std::vector<int> patches =
        patches_of(select(object, distances, {0, 1, 2}, options, seed));
    REQUIRE(patches.size() == 3);
    CHECK(patches[0] == 0);  // no other place has two partners
    options.pair_rule = PairRule::AllPairs;
    const TargetSelection all = select(object, distances, {0, 1, 2}, options, seed);
    CHECK_FALSE(all.targets);
    CHECK(all.failure == TargetFailure::NoFurther);
  }
}

// ---------------------------------------------------------------------------------------------
// Chance

/// The relative errors of a third contact's two edges and its centroid distance: what it is ranked
/// by.
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
  const TipDistances distances = equal_reach(3, 0.02, 0.30);
  const std::vector<int> fingers = {0, 1, 2};
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
  // For the first two at 90° and 210°, the place at 330° completes an equilateral triangle around
  // the center of mass; those beside it are worse but feasible.
  const grasp::ObjectModel object = object_of(on_unit_circle({90, 210, 330, 342, 318}));
  TargetOptions options;
  options.pool_fraction = 1e-9;
  options.pool_minimum = 5;
  std::set<int> thirds;
  for (int seed = 1; seed <= 300; ++seed) {
    const std::vector<int> patches =
        patches_of(select(object, equal_reach(3, 0.01, 3.0), {0, 1, 2}, options, seed));
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
    ++count[patches_of(select(object, equal_reach(2, 0.01, 3.0), {0, 1}, {}, seed)).at(0)];
  }
  // Uniform: 100 each with standard deviation 9.6; five of them.
  for (const int times : count) CHECK(std::abs(times - 100) < 48);
}

TEST_CASE("The same seed gives the same targets, other seeds give others",
          "[grasp][target_contacts]") {
  const grasp::ObjectModel object = object_of(geometry::torus(0.05, 0.018));
  const TipDistances distances = equal_reach(3, 0.02, 0.30);
  std::set<std::vector<int>> different;
  for (int seed = 1; seed <= 30; ++seed) {
    geometry::Random one(seed), two(seed);
    const TargetSelection a = grasp::select_target_contacts(object, distances, {0, 1, 2}, {}, one);
    const TargetSelection b = grasp::select_target_contacts(object, distances, {0, 1, 2}, {}, two);
    CHECK(patches_of(a) == patches_of(b));
    CHECK(a.seeds_tried == b.seeds_tried);
    CHECK(one.next() == two.next());  // as many numbers drawn
    different.insert(patches_of(a));
  }
  CHECK(different.size() >= 25);
}

// ---------------------------------------------------------------------------------------------
// Failures

TEST_CASE("No voxel above the threshold: no seed", "[grasp][target_contacts]") {
  const grasp::ObjectModel object = object_of(geometry::ball(0.05));
  const auto& scores = object.scores.scores;
  TargetOptions options;
  options.score_threshold = *std::max_element(scores.begin(), scores.end());
  REQUIRE(options.score_threshold < 1.0);  // on a ball nothing reaches 1.25 times the median
  const TargetSelection selection = select(object, equal_reach(3, 0, 1), {0, 1, 2}, options, 1);
  CHECK_FALSE(selection.targets);
  CHECK(selection.failure == TargetFailure::NoSeed);
}

TEST_CASE("An object wider than the fingers open: no second contact", "[grasp][target_contacts]") {
  // On a sphere a stable pair is more than 90° apart, so farther than sqrt(2) · 5 cm = 7.07 cm.
  // Normals of this icosphere's patches leave the radial direction by its faces' half width, 2.2°,
  // at most: 2 · 5 cm · sin(45° − 2.2°) = 6.8 cm.
  const grasp::ObjectModel object = object_of(geometry::ball(0.05));
  for (const std::vector<int>& fingers : {std::vector<int>{0, 1}, std::vector<int>{0, 1, 2}}) {
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
  const TargetSelection selection = select(object, equal_reach(3, 0.0, 0.3), {0, 1, 2}, options, 1);
  CHECK_FALSE(selection.targets);
  CHECK(selection.failure == TargetFailure::NoSecond);
}

TEST_CASE("Room for two contacts but not for three: no further contact",
          "[grasp][target_contacts]") {
  // A ball holds three points at most sqrt(3) · r apart, but two at 2 r.
  const grasp::ObjectModel object = object_of(geometry::ball(0.05));
  TargetOptions options;
  options.min_separation = 0.09;
  const TipDistances distances = equal_reach(3, 0.0, 0.3);
  CHECK(select(object, distances, {0, 1}, options, 1).targets);
  const TargetSelection selection = select(object, distances, {0, 1, 2}, options, 1);
  CHECK_FALSE(selection.targets);
  CHECK(selection.failure == TargetFailure::NoFurther);
}

TEST_CASE("No more seeds are tried than allowed", "[grasp][target_contacts]") {
  const grasp::ObjectModel object = object_of(geometry::ball(0.05));
  for (const int max_seeds : {1, 7, 60}) {
    TargetOptions options;
    options.max_seeds = max_seeds;
    const TargetSelection selection =
        select(object, equal_reach(3, 0.0, 0.067), {0, 1}, options, 1);
    CHECK_FALSE(selection.targets);
    CHECK(selection.seeds_tried == max_seeds);
  }
}

TEST_CASE("A target selection without two fingers is refused", "[grasp][target_contacts]") {
  const grasp::ObjectModel object = object_of(geometry::ball(0.05));
  const TipDistances distances = equal_reach(3, 0.0, 0.3);
  CHECK_THROWS_AS(select(object, distances, {}, {}, 1), geometry::InvalidInput);
  CHECK_THROWS_AS(select(object, distances, {0}, {}, 1), geometry::InvalidInput);
}

TEST_CASE("Target options out of range are refused by name and value", "[grasp][target_contacts]") {
  const auto message_of = [](auto set) {
    TargetOptions options;
    set(options);
    try {
      options.validate();
    } catch (const geometry::InvalidInput& error) {
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

}  // namespace
