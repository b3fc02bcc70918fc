#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "grasp/target_scenes.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/ranked_targets.hpp"
#include "support/catch.hpp"

namespace test_ranked_targets {

namespace {

using namespace graspfit;
using namespace graspfit::testing;
using grasp::PairRule;
using grasp::RankedTargets;
using grasp::TargetContacts;
using grasp::TargetFailure;

constexpr double kPi = std::numbers::pi;

/// Returns places on an ellipsoid with normals somewhat off it, so that no two sets of them rank
/// alike.
std::vector<Place> scattered(int count, std::uint64_t seed) {
  base::Random random(seed);
  const auto direction = [&] {
    const double z = random.uniform(-1.0, 1.0);
    const double azimuth = random.uniform(0.0, 2.0 * kPi);
    const double beside = std::sqrt(1.0 - z * z);
    return Vector3d(beside * std::cos(azimuth), beside * std::sin(azimuth), z);
  };
  std::vector<Place> places;
  for (int i = 0; i < count; ++i) {
    const Vector3d radial = direction();
    const Vector3d point = Vector3d(1.0, 0.8, 0.9).cwiseProduct(radial);
    places.push_back({point, radial + 0.2 * direction(), random.uniform(0.5, 1.0)});
  }
  return places;
}

/// A set of patches, the palm's last, with its rank in its best order.
struct OrderedSet {
  double rank;
  std::vector<int> patches;
  bool operator<(const OrderedSet& other) const {
    return std::tie(rank, patches) < std::tie(other.rank, other.patches);
  }
};

/// Returns the sum of numbers in ascending order, which is the same for every order in which they
/// are found.
double sum_of(std::vector<double> numbers) {
  std::sort(numbers.begin(), numbers.end());
  return std::accumulate(numbers.begin(), numbers.end(), 0.0);
}
double mean_of(const std::vector<double>& numbers) {
  return numbers.empty() ? 0.0 : sum_of(numbers) / static_cast<double>(numbers.size());
}

/// Returns the rank as the header defines it, for this order.
double rank_of(const grasp::ObjectModel& object, const RequestedParts& parts,
               const TargetOptions& options, const TargetContacts& targets) {
  const auto& contacts = targets.contacts;
  const double first = (contacts[1].point_O - contacts[0].point_O).norm();
  std::vector<double> edges, angles;
  for (std::size_t j = 0; j < parts.fingers.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      const Vector3d i_to_j = contacts[j].point_O - contacts[i].point_O;
      if (j >= 2) edges.push_back(std::abs(i_to_j.norm() - first) / first);
      if (i > 0 && options.pair_rule == PairRule::Seed) continue;
      angles.push_back(0.5 * (angle_between(contacts[i].outward_normal_O, -i_to_j) +
                              angle_between(contacts[j].outward_normal_O, i_to_j)));
    }
  }
  Vector3d centroid;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> coordinates;
    for (const auto& contact : contacts) coordinates.push_back(contact.point_O[axis]);
    centroid[axis] = mean_of(coordinates);
  }
  return mean_of(edges) +
         (centroid - object.mass.center_of_mass).norm() / object.normalizing_radius +
         options.angle_weight * mean_of(angles) / options.theta_max;
}

/// Orders sets whose ranks agree but for rounding by ascending patches: with all pairs, for
/// example, a seed and a second target that change places.
std::vector<OrderedSet> with_ties_by_patch(std::vector<OrderedSet> sets) {
  for (auto from = sets.begin(); from != sets.end();) {
    auto to = from + 1;
    while (to != sets.end() && to->rank - (to - 1)->rank < kRounding) ++to;
    std::sort(from, to, [](const auto& a, const auto& b) { return a.patches < b.patches; });
    from = to;
  }
  return sets;
}

/// Finds all feasible sets by trying every sequence of places.
std::vector<OrderedSet> by_brute_force(const grasp::ObjectModel& object,
                                       const PartDistances& distances, const RequestedParts& parts,
                                       const TargetOptions& options) {
  // The key has the seed, the further fingers and the palm.
  using Key = std::tuple<int, std::set<int>, int>;
  std::map<Key, OrderedSet> best;
  const int num_places = static_cast<int>(object.patches.size());
  TargetContacts targets;
  const std::size_t size = static_cast<std::size_t>(parts.size());
  const std::size_t num_fingers = parts.fingers.size();
  std::vector<int> sequence(size, 0);
  const auto visit = [&](const auto& self, std::size_t k) -> void {
    if (k == size) {
      if (!broken_requirements(object, distances, parts, options, targets).empty()) return;
      const Key key{sequence[0],
                    {sequence.begin() + 1, sequence.begin() + static_cast<long>(num_fingers)},
                    parts.palm ? sequence.back() : -1};
      const OrderedSet found{rank_of(object, parts, options, targets), sequence};
      const auto [entry, is_new] = best.try_emplace(key, found);
      if (!is_new && found < entry->second) entry->second = found;
      return;
    }
    for (int place = 0; place < num_places; ++place) {
      if (std::find(sequence.begin(), sequence.begin() + static_cast<long>(k), place) !=
          sequence.begin() + static_cast<long>(k)) {
        continue;
      }
      sequence[k] = place;
      const geometry::SurfacePatch& patch = object.patches[place];
      if (!(object.scores.scores[place] > options.score_threshold)) continue;
      targets.contacts.resize(k);
      targets.contacts.push_back({patch.centroid, patch.outward_normal, place,
                                  object.scores.scores[place], k == num_fingers});
      self(self, k + 1);
      targets.contacts.resize(k);
    }
  };
  visit(visit, 0);
  std::vector<OrderedSet> sets;
  for (const auto& [key, set] : best) sets.push_back(set);
  std::sort(sets.begin(), sets.end());
  return with_ties_by_patch(sets);
}

struct Case {
  std::string name;
  int num_places;
  RequestedParts parts;
  TargetOptions options;
};

std::vector<Case> cases() {
  TargetOptions plain;
  plain.search = grasp::TargetSearch::Ranked;
  plain.min_separation = 0.3;
  TargetOptions by_angle = plain;
  by_angle.angle_weight = 1.0;
  by_angle.theta_max = 0.9;
  TargetOptions all_pairs = by_angle;
  all_pairs.pair_rule = PairRule::AllPairs;
  TargetOptions loose = plain;
  loose.edge_tolerance_rel = 0.6;
  loose.centroid_limit_rel = 10.0;
  loose.theta_max = 1.2;
  return {{"two", 60, {{1, 2}}, plain},
          {"two by angle", 60, {{0, 2}}, by_angle},
          {"three", 40, {{0, 1, 2}}, plain},
          {"three by angle", 40, {{2, 0, 1}}, by_angle},
          {"three, all pairs", 40, {{0, 1, 2}}, all_pairs},
          {"three, loose", 24, {{0, 1, 2}}, loose},
          {"four", 13, {{0, 1, 2, 3}}, loose},
          {"five", 9, {{0, 1, 2, 3, 4}}, loose},
          {"two and the palm", 22, {{0, 1}, true}, plain},
          {"three and the palm", 14, {{0, 1, 2}, true}, loose}};
}

/// Returns five fingers with different ranges, some of which leave one way only to give targets to
/// fingers.
PartDistances uneven_reach() {
  PartDistances distances = equal_reach(5, 0.2, 2.2);
  set_range(distances, 0, 1, {1.0, 1.7});
  set_range(distances, 0, 2, {1.5, 2.2});
  set_range(distances, 1, 2, {0.4, 1.6});
  distances.palm_to_tip.assign(5, {0.3, 1.6});
  distances.palm_to_tip[1] = {0.8, 1.9};
  distances.palm = grasp::PalmReach{Vector3d::Zero(), Vector3d::UnitZ(), 0.15, {}};
  return distances;
}

TEST_CASE("The ranked search gives the sets of brute force, each once, in its order",
          "[grasp][target_contacts][ranked_targets]") {
  const PartDistances distances = uneven_reach();
  for (const Case& c : cases()) {
    INFO(c.name);
    const grasp::ObjectModel object = object_of(scattered(c.num_places, 7));
    const std::vector<OrderedSet> expected = by_brute_force(object, distances, c.parts, c.options);
    CHECK(expected.size() >= 5);
    RankedTargets ranked(object, distances, c.parts, c.options);
    std::vector<OrderedSet> given;
    while (const auto targets = ranked.next()) {
      given.push_back({targets->rank, patches_of(*targets)});
      if (given.size() > expected.size()) break;
    }
    REQUIRE(given.size() == expected.size());
    CHECK(std::is_sorted(given.begin(), given.end()));
    given = with_ties_by_patch(given);
    for (std::size_t i = 0; i < given.size(); ++i) {
      INFO("set " << i);
      CHECK(std::abs(given[i].rank - expected[i].rank) < kRounding);
      CHECK(given[i].patches == expected[i].patches);
    }
    CHECK_FALSE(ranked.next());
  }
}

TEST_CASE("More sets than are kept at a time come in order and without a gap",
          "[grasp][target_contacts][ranked_targets]") {
  const grasp::ObjectModel object = object_of(scattered(90, 3));
  const PartDistances distances = equal_reach(3, 0.1, 3.0);
  TargetOptions options;
  options.search = grasp::TargetSearch::Ranked;
  options.edge_tolerance_rel = 0.5;
  RankedTargets ranked(object, distances, {{0, 1, 2}}, options);
  std::set<std::vector<int>> sets;
  double last = 0.0;
  std::size_t count = 0;
  while (const auto targets = ranked.next()) {
    CHECK(targets->rank >= last);
    last = targets->rank;
    std::vector<int> patches = patches_of(*targets);
    std::sort(patches.begin() + 1, patches.end());
    sets.insert(patches);
    ++count;
  }
  CHECK(sets.size() == count);
  // The sets are counted apart: for every seed the pairs of places by which it can be completed.
  std::size_t expected = 0;
  TargetContacts targets;
  const auto add = [&](int place) {
    targets.contacts.push_back({object.patches[place].centroid,
                                object.patches[place].outward_normal, place,
                                object.scores.scores[place]});
  };
  const auto are_stable = [&](int a, int b) {
    targets.contacts.clear();
    add(a);
    add(b);
    TargetOptions pair_options = options;
    pair_options.centroid_limit_rel = 100.0;
    return broken_requirements(object, distances, {{0, 1}}, pair_options, targets).empty();
  };
  const int size = static_cast<int>(object.patches.size());
  for (int seed = 0; seed < size; ++seed) {
    std::vector<int> partners;
    for (int place = 0; place < size; ++place) {
      if (place != seed && are_stable(seed, place)) partners.push_back(place);
    }
    for (const int a : partners) {
      for (const int b : partners) {
        if (b <= a) continue;
        const auto is_feasible = [&](int second, int third) {
          targets.contacts.clear();
          for (const int place : {seed, second, third}) add(place);
          return broken_requirements(object, distances, {{0, 1, 2}}, options, targets).empty();
        };
        if (is_feasible(a, b) || is_feasible(b, a)) ++expected;
      }
    }
  }
  CHECK(count == expected);
  // The search keeps a fraction of these at a time.
  CHECK(count > 5000);
}

TEST_CASE("No random set within the unrelaxed limits ranks before the first ranked one",
          "[grasp][target_contacts][ranked_targets]") {
  const PartDistances distances = equal_reach(3, 0.02, 0.30);
  for (const NamedMesh& shape : shapes()) {
    grasp::ObjectModelOptions model_options;
    model_options.resolution = 12;
    const grasp::ObjectModel object = grasp::build_object_model(shape.mesh, model_options);
    INFO(shape.name);
    TargetOptions options;
    options.min_separation = 0.02;
    options.search = grasp::TargetSearch::Ranked;
    RankedTargets ranked(object, distances, {{0, 1, 2}}, options);
    const auto first = ranked.next();
    REQUIRE(first);
    CHECK(broken_requirements(object, distances, {{0, 1, 2}}, options, *first).empty());
    for (int seed = 1; seed <= 20; ++seed) {
      const TargetSelection drawn = select(object, distances, {{0, 1, 2}}, options, seed);
      if (!drawn.targets || drawn.seeds_tried > options.relax_after_seeds) continue;
      CHECK(drawn.targets->rank >= first->rank - kRounding);
    }
  }
}

TEST_CASE("Where no set exists the ranked search says at which stage",
          "[grasp][target_contacts][ranked_targets]") {
  TargetOptions options;
  options.search = grasp::TargetSearch::Ranked;
  PartDistances distances = equal_reach(3, 0.1, 3.0);
  RequestedParts parts{{0, 1, 2}};
  std::vector<Place> places = on_unit_circle({0, 120, 240});
  TargetFailure expected = TargetFailure::NoSecond;
  SECTION("no place exceeds the threshold") {
    options.score_threshold = 0.95;
    expected = TargetFailure::NoSeed;
  }
  SECTION("two plates farther apart than the fingers") {
    places.clear();
    for (const double z : {-0.5, 0.5}) {
      for (int i = 0; i < 25; ++i) {
        places.push_back({Vector3d(0.1 * (i % 5), 0.1 * (i / 5), z), Vector3d(0, 0, z)});
      }
    }
    distances = equal_reach(3, 0.1, 0.99);
  }
  SECTION("a cone steeper than the friction cone") {
    // The cone has half angle a: the two inward normals of a pair differ by a horizontal vector of
    // length at most 2 cos(a), and by more than 2 cos(theta_max) along the line between stable
    // places.
    places.clear();
    const double half_angle = 0.6;
    options.theta_max = 0.59;
    for (int i = 0; i < 60; ++i) {
      const double azimuth = 0.5 * i, radius = 0.2 + 0.012 * i;
      const Vector3d radial(std::cos(azimuth), std::sin(azimuth), 0.0);
      places.push_back({radius * radial - radius / std::tan(half_angle) * Vector3d::UnitZ(),
                        std::cos(half_angle) * radial + std::sin(half_angle) * Vector3d::UnitZ()});
    }
  }
  SECTION("pairs but no triangle") {
    places = on_unit_circle({0, 180});
    expected = TargetFailure::NoFurther;
  }
  SECTION("a triangle that no fingers fit: each two places do for some two fingers") {
    set_range(distances, 0, 1, {0.1, 1.8});
    set_range(distances, 0, 2, {0.1, 1.0});
    expected = TargetFailure::NoFurther;
  }
  SECTION("no place for the palm") {
    parts.palm = true;
    distances.palm_to_tip.assign(3, {0.1, 3.0});
    distances.palm = grasp::PalmReach{Vector3d::Zero(), Vector3d::UnitZ(), 0.1, {}};
    expected = TargetFailure::NoPalm;
  }
  const grasp::ObjectModel object = object_of(places);
  RankedTargets ranked(object, distances, parts, options);
  CHECK_FALSE(ranked.next());
  CHECK(ranked.failure() == expected);
  CHECK_FALSE(ranked.next());
  // The random search agrees.
  const TargetSelection drawn = select(object, distances, parts, options, 1);
  CHECK_FALSE(drawn.targets);
  CHECK(drawn.failure == expected);
}

TEST_CASE("A thinned pool keeps the best place of each cell and side",
          "[grasp][target_contacts][ranked_targets]") {
  // A thin plate has four places in one cell on either side, of which the better of each is left.
  std::vector<Place> places;
  for (const double z : {0.01, 0.02}) {
    for (int i = 0; i < 4; ++i) {
      places.push_back(
          {Vector3d(0.01 + 0.01 * i, 0.01, z), Vector3d(0, 0, z - 0.015), i == 2 ? 0.9 : 0.8});
    }
  }
  const grasp::ObjectModel object = object_of(places);
  const PartDistances distances = equal_reach(2, 0.001, 1.0);
  TargetOptions options;
  options.search = grasp::TargetSearch::Ranked;
  options.pool_spacing = 0.2;
  RankedTargets ranked(object, distances, {{0, 1}}, options);
  std::vector<std::vector<int>> sets;
  while (const auto targets = ranked.next()) sets.push_back(patches_of(*targets));
  CHECK(sets == std::vector<std::vector<int>>{{2, 6}, {6, 2}});
  for (int seed = 1; seed <= 10; ++seed) {
    const std::vector<int> drawn = patches_of(select(object, distances, {{0, 1}}, options, seed));
    CHECK((drawn == sets[0] || drawn == sets[1]));
  }
}

}  // namespace

}  // namespace test_ranked_targets
