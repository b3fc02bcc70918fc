#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "grasp/planner_promises.hpp"
#include "graspfit/contact/grasp_wrench_space.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/grasp/option_names.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_grasp_planner {

namespace {

using namespace graspfit;
using namespace graspfit::testing;
using testing::Contains;

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

// The following tests are about what is returned.

TEST_CASE("Valid grasps keep every promise on every shape", "[grasp][grasp_planner]") {
  for (const NamedMesh& shape : shapes()) {
    INFO(shape.name);
    const Run run(shape.mesh, collecting(Acceptance::Valid, 2, 60));
    const PlannerResult result = run.plan();
    CHECK(broken_promises(run, result) == kNothing);
    CHECK_FALSE(result.grasps.empty());
  }
}

TEST_CASE("Usable grasps keep every promise, and none is left out", "[grasp][grasp_planner]") {
  const bool is_grazing = GENERATE(false, true);
  for (const NamedMesh& shape : shapes()) {
    PlannerOptions options = collecting(Acceptance::Usable, 1000, 6);
    options.refine = false;
    if (is_grazing) {
      options.fitting.guard = grasp::PenetrationGuard::Voxels;
      options.fitting.contact_state = grasp::ContactState::FirstGraze;
    }
    INFO(shape.name << (is_grazing ? ", guarded by voxels, first graze"
                                   : ", guarded by meshes, closed"));
    const Run run(shape.mesh, options);
    const PlannerResult result = run.plan();
    CHECK(result.stop == PlannerStop::Attempts);
    CHECK(broken_promises(run, result) == kNothing);
    CHECK(static_cast<std::int64_t>(result.grasps.size()) == result.statistics.usable());
  }
}

TEST_CASE("Grasps that miss their targets or their quality are rejected, and counted apart",
          "[grasp][grasp_planner]") {
  PlannerOptions options = collecting(Acceptance::Usable, 1000, 40);
  options.refine = false;
  const geometry::TriangleMesh mesh = geometry::capsule(0.03, 0.08);
  const PlannerResult all = Run(mesh, options).plan();
  REQUIRE(all.grasps.size() > 4);
  std::vector<double> deviations;
  for (const Grasp& grasp : all.grasps) {
    const std::vector<double> distances = grasp::target_distances(grasp);
    deviations.push_back(*std::max_element(distances.begin(), distances.end()));
  }
  std::nth_element(deviations.begin(), deviations.begin() + deviations.size() / 2,
                   deviations.end());
  // Half of the grasps deviate more.
  options.largest_deviation = deviations[deviations.size() / 2];
  for (const auto rejection : {grasp::Rejection::Deviation, grasp::Rejection::Quality}) {
    options.rejection = rejection;
    INFO(grasp::name_of(rejection));
    const Run run(mesh, options);
    const PlannerResult result = run.plan();
    CHECK(broken_promises(run, result) == kNothing);
    CHECK_FALSE(result.grasps.empty());
    CHECK(result.statistics.outcomes.at(grasp::AttemptOutcome::Rejected) > 0);
    CHECK(result.grasps.size() < all.grasps.size());
    CHECK(static_cast<std::int64_t>(result.grasps.size()) == result.statistics.usable());
  }
}

TEST_CASE("Open grasps do not count towards a search for closed ones, and fill up where it ends",
          "[grasp][grasp_planner]") {
  const geometry::TriangleMesh mesh = geometry::torus(0.05, 0.015);
  constexpr int kAttempts = 40;
  const PlannerResult all = Run(mesh, collecting(Acceptance::Valid, 1000, kAttempts)).plan();
  std::vector<std::int64_t> closed, open;  // attempts
  for (const Grasp& grasp : all.grasps) {
    (grasp.is_closed() ? closed : open).push_back(grasp.attempt);
  }
  REQUIRE(closed.size() > 3);
  REQUIRE(open.size() > 3);
  const auto attempts = [](const PlannerResult& result) {
    std::vector<std::int64_t> numbers;
    for (const Grasp& grasp : result.grasps) numbers.push_back(grasp.attempt);
    return numbers;
  };
  {
    INFO("as many as are asked for");
    PlannerOptions options = collecting(Acceptance::Valid, 3, kAttempts);
    options.search = SearchRule::Closed;
    const Run run(mesh, options);
    const PlannerResult result = run.plan();
    CHECK(broken_promises(run, result) == kNothing);
    CHECK(result.stop == PlannerStop::Count);
    std::vector<std::int64_t> first = closed;
    std::sort(first.begin(), first.end());
    first.resize(3);
    CHECK(result.statistics.attempts == first.back() + 1);
    std::vector<std::int64_t> found = attempts(result);
    std::sort(found.begin(), found.end());
    CHECK(found == first);
    CHECK(all_fields(result) == all_fields(run.plan(3)));
  }
  {
    INFO("more than there are: the best open ones fill up");
    PlannerOptions options =
        collecting(Acceptance::Valid, static_cast<int>(closed.size()) + 2, kAttempts);
    options.search = SearchRule::Closed;
    const Run run(mesh, options);
    const PlannerResult result = run.plan();
    CHECK(broken_promises(run, result) == kNothing);
    CHECK(result.stop == PlannerStop::Attempts);
    std::vector<std::int64_t> expected = closed;  // as ranked
    expected.insert(expected.end(), open.begin(), open.begin() + 2);
    CHECK(attempts(result) == expected);
  }
  {
    INFO("alike ones count once");
    PlannerOptions options = collecting(Acceptance::Valid, 1000, kAttempts);
    options.search = SearchRule::Closed;
    options.distinct = {.translation = 1.0, .rotation = 4.0, .joints = 10.0};
    const Run run(mesh, options);
    const PlannerResult result = run.plan();
    CHECK(broken_promises(run, result) == kNothing);
    CHECK(attempts(result) == std::vector{*std::min_element(closed.begin(), closed.end())});
    CHECK(result.statistics.duplicates == static_cast<std::int64_t>(all.grasps.size()) - 1);
  }
}

TEST_CASE("Rank epsilon orders grasps by how hard they are to break, and leaves the stronger ones",
          "[grasp][grasp_planner]") {
  PlannerOptions options = collecting(Acceptance::Valid, 1000, 40);
  options.search = grasp::SearchRule::Best;
  options.style = grasp::GraspStyle::Power;
  const geometry::TriangleMesh mesh = geometry::capsule(0.03, 0.08);
  const PlannerResult by_m = Run(mesh, options).plan();
  options.rank = grasp::RankRule::Epsilon;
  const Run run(mesh, options);
  const contact::WrenchObject object =
      contact::wrench_object(run.object.mesh(), run.object.mass.center_of_mass);
  const auto strength = [&](const Grasp& grasp) {
    const std::vector<contact::Contact> touching =
        contact::touching_contacts(grasp.contacts, grasp::bearing_gap(options));
    return contact::signed_epsilon(touching, object, options.squeeze_friction);
  };
  const auto attempts = [](const PlannerResult& result) {
    std::vector<std::int64_t> numbers;
    for (const Grasp& grasp : result.grasps) numbers.push_back(grasp.attempt);
    return numbers;
  };
  std::vector<Grasp> expected = by_m.grasps;  // The largest M first, as among equally strong ones.
  REQUIRE(expected.size() > 4);
  std::stable_sort(expected.begin(), expected.end(),
                   [&](const Grasp& a, const Grasp& b) { return strength(a) > strength(b); });
  std::vector<std::int64_t> numbers;
  for (const Grasp& grasp : expected) numbers.push_back(grasp.attempt);
  CHECK(attempts(run.plan()) == numbers);
  CHECK(attempts(by_m) != numbers);

  options.count = 2;
  const PlannerResult two = Run(mesh, options).plan();
  CHECK(attempts(two) == std::vector<std::int64_t>{numbers[0], numbers[1]});
}

TEST_CASE("Without a length of its own a deviation is too large from a pad's width on",
          "[grasp][grasp_planner]") {
  PlannerOptions options;
  const hands::HandModel barrett = hands::find_hand("barrett");
  // It is the width of the outline of its pads.
  CHECK(grasp::largest_deviation(options, barrett) == Approx(0.023));
  options.largest_deviation = 0.01;
  CHECK(grasp::largest_deviation(options, barrett) == 0.01);
}

TEST_CASE("Two fingers grasp too", "[grasp][grasp_planner]") {
  PlannerOptions options = collecting(Acceptance::Usable, 1000, 8);
  options.num_contacts = 2;
  const Run run(geometry::box(Vector3d(0.12, 0.05, 0.05)), options);
  const PlannerResult result = run.plan();
  CHECK(broken_promises(run, result) == kNothing);
  CHECK_FALSE(result.grasps.empty());
}

TEST_CASE("A wanted approach direction is kept", "[grasp][grasp_planner]") {
  for (const Vector3d& approach : {Vector3d(0, 0, -2), Vector3d(1, 1, 0.5)}) {
    PlannerOptions options = collecting(Acceptance::Usable, 1000, 6);
    options.approach_O = approach;
    const Run run(geometry::ball(0.05), options);
    const PlannerResult result = run.plan();
    CHECK(broken_promises(run, result) == kNothing);
    CHECK_FALSE(result.grasps.empty());
  }
}

TEST_CASE("How hard grasps are squeezed, and within which cones, changes their squeezes alone",
          "[grasp][grasp_planner]") {
  const geometry::TriangleMesh mesh = geometry::capsule(0.03, 0.08);
  PlannerOptions options = collecting(Acceptance::Valid, 1000, 6);
  PlannerResult firm = Run(mesh, options).plan();
  options.squeeze_friction = options.friction;
  options.squeeze.normal_sum /= 2.0;
  PlannerResult soft = Run(mesh, options).plan();
  REQUIRE(firm.grasps.size() == soft.grasps.size());
  REQUIRE_FALSE(firm.grasps.empty());
  for (std::size_t i = 0; i < firm.grasps.size(); ++i) {
    CHECK(all_fields(firm.grasps[i]) != all_fields(soft.grasps[i]));
    firm.grasps[i].squeeze.reset();
    soft.grasps[i].squeeze.reset();
    CHECK(all_fields(firm.grasps[i]) == all_fields(soft.grasps[i]));
  }
}

TEST_CASE("Attempts that prefer balance end in more squeezes that balance, and lose no grasp by it",
          "[grasp][grasp_planner]") {
  PlannerOptions options = collecting(Acceptance::Valid, 1000, 12);
  options.counted_pads = contact::CountedPads::All;
  const auto num_balanced = [](const PlannerResult& result) {
    return std::count_if(result.grasps.begin(), result.grasps.end(),
                         [](const Grasp& grasp) { return grasp.squeeze->is_balanced; });
  };
  std::ptrdiff_t num_any = 0;
  std::ptrdiff_t num_preferring = 0;
  std::size_t num_grasps_any = 0;
  std::size_t num_grasps_preferring = 0;
  for (const geometry::TriangleMesh& mesh :
       {geometry::ball(0.045), geometry::box({0.06, 0.08, 0.1}), geometry::torus(0.05, 0.02)}) {
    options.candidate_order = CandidateOrder::Pads;
    options.kept = KeptCandidate::First;
    const PlannerResult any = Run(mesh, options).plan();
    options.candidate_order = CandidateOrder::Balance;
    options.kept = KeptCandidate::Balanced;
    const Run run(mesh, options);
    const PlannerResult balanced = run.plan();
    CHECK(broken_promises(run, balanced) == kNothing);
    num_grasps_any += any.grasps.size();
    num_grasps_preferring += balanced.grasps.size();
    CHECK(num_balanced(balanced) >= num_balanced(any));
    num_any += num_balanced(any);
    num_preferring += num_balanced(balanced);
  }
  CHECK(num_preferring > num_any);
  INFO(num_grasps_preferring << " grasps that prefer balance, " << num_grasps_any << " others");
  CHECK(num_grasps_preferring + 6 >= num_grasps_any);  // There are 36 attempts.
}

TEST_CASE("Attempts that keep the strongest grasp keep the one that trying all sides would show",
          "[grasp][grasp_planner]") {
  // The oracle is epsilon within the squeeze's cones, from the contacts that the grasps report.
  const auto strength = [](const Run& run, const Grasp& grasp) {
    std::vector<contact::Contact> touching;
    for (const contact::Contact& contact : grasp.contacts) {
      if (contact.gap <= run.options.refinement.largest_gap) touching.push_back(contact);
    }
    contact::WrenchConvention convention = contact::wrench_convention(
        contact::WrenchTool::Graspfit,
        contact::wrench_object(run.object.mesh(), run.object.mass.center_of_mass), touching,
        run.options.squeeze_friction);
    convention.options.outside = contact::OutsideValue::Signed;
    return std::make_pair(
        grasp.squeeze->is_balanced,
        contact::epsilon_quality(contact::grasp_wrench_space(touching, convention)));
  };
  PlannerOptions options = collecting(Acceptance::Valid, 1000, 4);
  options.candidate_order = CandidateOrder::Balance;
  options.kept = KeptCandidate::Strongest;
  std::int64_t num_stronger = 0;
  for (const geometry::TriangleMesh& mesh :
       {geometry::ball(0.045), geometry::box({0.06, 0.08, 0.1})}) {
    std::map<std::int64_t, std::pair<bool, double>> fewer;
    for (const int placements : {1, 4, 12}) {
      options.max_placements = placements;
      const Run run(mesh, options);
      const PlannerResult result = run.plan();
      CHECK(broken_promises(run, result) == kNothing);
      std::map<std::int64_t, std::pair<bool, double>> found;
      for (const Grasp& grasp : result.grasps) found[grasp.attempt] = strength(run, grasp);
      for (const auto& [attempt, least] : fewer) {
        // More of the same sides are tried in the same order: the result is never weaker, and none
        // is lost.
        REQUIRE(found.count(attempt) == 1);
        CHECK(found[attempt] >= least);
        num_stronger += found[attempt] > least;
      }
      fewer = found;
    }
    CHECK(fewer.size() == 4);
  }
  CHECK(num_stronger > 0);
}

TEST_CASE("Progress is told after every attempt", "[grasp][grasp_planner]") {
  const Run run(geometry::ball(0.05), collecting(Acceptance::Usable, 2, 30));
  std::vector<std::pair<std::int64_t, std::int64_t>> calls;
  const PlannerResult result = grasp::plan_grasps(
      run.object, run.hand, run.options, {},
      {.num_threads = 2, .progress = [&](std::int64_t attempts, std::int64_t grasps) {
         calls.emplace_back(attempts, grasps);
       }});
  REQUIRE(static_cast<std::int64_t>(calls.size()) == result.statistics.attempts);
  std::int64_t found = 0;
  for (std::size_t i = 0; i < calls.size(); ++i) {
    CHECK(calls[i].first == static_cast<std::int64_t>(i) + 1);
    CHECK((calls[i].second == found || calls[i].second == found + 1));
    found = calls[i].second;
  }
  CHECK(found == static_cast<std::int64_t>(result.grasps.size()));
}

TEST_CASE("Outcomes have names of their own", "[grasp][grasp_planner]") {
  std::set<std::string> names;
  for (const AttemptOutcome outcome : kOutcomes) names.insert(grasp::outcome_name(outcome));
  CHECK(names.size() == kOutcomes.size());
  CHECK_FALSE(names.contains(""));
}

// The following tests are about reproducibility.

TEST_CASE("The same seed gives the same bytes, another seed another result",
          "[grasp][grasp_planner]") {
  const geometry::TriangleMesh mesh = geometry::torus(0.05, 0.018);
  PlannerOptions options = collecting(Acceptance::Usable, 1000, 4);
  const Run run(mesh, options);
  const std::string once = all_fields(run.plan());
  CHECK(once == all_fields(run.plan()));
  // Everything is prepared anew.
  CHECK(once == all_fields(Run(mesh, options).plan()));
  for (const int num_threads : {1, 2, 5}) CHECK(once == all_fields(run.plan(num_threads)));
  options.seed = 2;
  const Run other(mesh, options);
  CHECK(once != all_fields(other.plan()));
}

TEST_CASE("An attempt's grasp depends on the seed and its number alone", "[grasp][grasp_planner]") {
  // To ask for fewer grasps, or to accept fewer, changes which are returned and not what they are.
  const geometry::TriangleMesh mesh = geometry::capsule(0.03, 0.08);
  const PlannerResult all = Run(mesh, collecting(Acceptance::Usable, 1000, 8)).plan();
  for (const PlannerOptions& fewer :
       {collecting(Acceptance::Usable, 2, 8), collecting(Acceptance::Valid, 1000, 8),
        collecting(Acceptance::Usable, 1000, 4)}) {
    const PlannerResult some = Run(mesh, fewer).plan();
    CHECK(some.grasps.size() <= all.grasps.size());
    for (const Grasp& grasp : some.grasps) {
      const auto same = std::find_if(all.grasps.begin(), all.grasps.end(),
                                     [&](const Grasp& g) { return g.attempt == grasp.attempt; });
      REQUIRE(same != all.grasps.end());
      CHECK(all_fields(*same) == all_fields(grasp));
    }
  }
}

TEST_CASE("The best of all attempts are those that collecting all of them ranks first",
          "[grasp][grasp_planner]") {
  const geometry::TriangleMesh mesh = geometry::ball(0.05);
  const PlannerResult all = Run(mesh, collecting(Acceptance::Usable, 1000, 8)).plan();
  REQUIRE(all.grasps.size() >= 3);
  PlannerOptions options = collecting(Acceptance::Usable, 2, 8);
  options.search = SearchRule::Best;
  const Run run(mesh, options);
  const PlannerResult best = run.plan();
  CHECK(broken_promises(run, best) == kNothing);
  REQUIRE(best.grasps.size() == 2);
  CHECK(all_fields(best.grasps[0]) == all_fields(all.grasps[0]));
  CHECK(all_fields(best.grasps[1]) == all_fields(all.grasps[1]));
}

TEST_CASE("A time limit stops the work and is recorded", "[grasp][grasp_planner]") {
  PlannerOptions options = collecting(Acceptance::Usable, 100000, 100000);
  options.wall_clock_limit_s = 0.05;
  const Run run(geometry::ball(0.05), options);
  const PlannerResult result = run.plan();
  CHECK(result.stop == PlannerStop::WallClock);
  CHECK(result.statistics.attempts < 100000);
  std::int64_t sum = 0;
  for (const auto& [outcome, count] : result.statistics.outcomes) sum += count;
  CHECK(sum == result.statistics.attempts);
}

TEST_CASE("A stop ends the work with what the attempts before have found",
          "[grasp][grasp_planner]") {
  const geometry::TriangleMesh mesh = geometry::ball(0.05);
  const PlannerOptions options = collecting(Acceptance::Usable, 100000, 100000);
  const Run run(mesh, options);
  for (const int num_threads : {1, 3}) {
    std::stop_source source;
    const PlannerResult result = plan_grasps(run.object, run.hand, options, {},
                                             {.num_threads = num_threads,
                                              .progress =
                                                  [&](std::int64_t attempts, std::int64_t) {
                                                    if (attempts == 4) source.request_stop();
                                                  },
                                              .stop = source.get_token()});
    CHECK(result.stop == PlannerStop::Interrupted);
    // Those under way on the other threads count, too.
    CHECK(result.statistics.attempts >= 4);
    CHECK(result.statistics.attempts < 100000);
    const PlannerResult same = Run(mesh, collecting(Acceptance::Usable, 100000,
                                                    static_cast<int>(result.statistics.attempts)))
                                   .plan();
    REQUIRE(result.grasps.size() == same.grasps.size());
    for (std::size_t i = 0; i < same.grasps.size(); ++i) {
      CHECK(all_fields(result.grasps[i]) == all_fields(same.grasps[i]));
    }
  }
}

TEST_CASE("Contacts keep to surface with a high score where that is asked for",
          "[grasp][grasp_planner]") {
  const geometry::TriangleMesh mesh = geometry::box(Vector3d(0.10, 0.06, 0.08));
  const auto lowest_score = [](const Run& run, const Grasp& grasp) {
    double lowest = 1.0;
    for (const contact::Contact& contact : grasp.contacts) {
      lowest = std::min(lowest, grasp::contact_score_at(run.object, contact.point_O).value_or(0.0));
    }
    return lowest;
  };
  PlannerOptions options = collecting(Acceptance::Usable, 1000, 30);
  // Otherwise another side would be tried where the first is turned down.
  options.max_placements = 1;
  const Run free(mesh, options);
  const PlannerResult all = free.plan();
  // Where nothing forbids it, edges are touched: the threshold is one that half of the grasps
  // exceed.
  std::vector<double> scores;
  for (const Grasp& grasp : all.grasps) scores.push_back(lowest_score(free, grasp));
  std::sort(scores.begin(), scores.end());
  REQUIRE(scores.size() >= 4);
  const double threshold = scores[(scores.size() - 1) / 2];
  REQUIRE(threshold < scores.back());
  options.contact_score_threshold = threshold;
  const Run bound(mesh, options);
  const PlannerResult kept = bound.plan();
  std::set<std::int64_t> expected;
  for (const Grasp& grasp : all.grasps) {
    if (lowest_score(free, grasp) > threshold) expected.insert(grasp.attempt);
  }
  std::set<std::int64_t> found;
  for (const Grasp& grasp : kept.grasps) found.insert(grasp.attempt);
  CHECK(found == expected);
  CHECK_FALSE(found.empty());
  CHECK(found.size() < all.grasps.size());
  CHECK(kept.statistics.usable() == all.statistics.usable());
}

TEST_CASE("A budget of iterations ends the run at the attempt that reaches it, on any threads",
          "[grasp][grasp_planner]") {
  const geometry::TriangleMesh mesh = geometry::torus(0.05, 0.018);
  const auto used_by = [&](int max_attempts) {
    const PlannerResult result =
        Run(mesh, collecting(Acceptance::Usable, 1000, max_attempts)).plan();
    return result.statistics.fitting_iterations + result.statistics.refinement_iterations;
  };
  const std::int64_t by_two = used_by(2);
  const std::int64_t by_three = used_by(3);
  REQUIRE(by_two < by_three);
  for (const std::int64_t budget : {by_two + 1, by_three}) {
    PlannerOptions options = collecting(Acceptance::Usable, 1000, 40);
    options.max_iterations = budget;
    const Run run(mesh, options);
    const PlannerResult result = run.plan(1);
    CHECK(result.stop == PlannerStop::Iterations);
    CHECK(result.statistics.attempts == 3);
    CHECK(result.statistics.fitting_iterations + result.statistics.refinement_iterations ==
          by_three);
    for (const int num_threads : {2, 5})
      CHECK(all_fields(result) == all_fields(run.plan(num_threads)));
  }
}

TEST_CASE("A turned object is grasped as often", "[grasp][grasp_planner]") {
  constexpr int kAttempts = 20;
  const geometry::TriangleMesh mesh = geometry::box(Vector3d(0.10, 0.06, 0.08));
  geometry::RigidTransform X_WO = geometry::RigidTransform::Identity();
  // It is 90° about z, exactly.
  X_WO.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const auto usable_of = [&](const geometry::TriangleMesh& turned) {
    return static_cast<double>(
        Run(turned, collecting(Acceptance::Usable, 1000, kAttempts)).plan().statistics.usable());
  };
  const double plain = usable_of(mesh), turned = usable_of(geometry::transformed(mesh, X_WO));
  // Both are counts out of 20 with the same chance, so that their difference has a standard
  // deviation of at most sqrt(2 · 20 / 4) = 3.2; the bound is four of them.
  INFO(plain << " and " << turned << " of " << kAttempts);
  CHECK(std::abs(plain - turned) <= 13.0);
  CHECK(plain > 0.0);
  CHECK(turned > 0.0);
}

// The following tests are about failures.

TEST_CASE("A threshold that no voxel exceeds is reported as no seed", "[grasp][grasp_planner]") {
  PlannerOptions options = collecting(Acceptance::Valid, 1, 5);
  // A ball's scores are near 0.8 everywhere.
  options.targets.score_threshold = 0.999999;
  const Run run(geometry::ball(0.05), options);
  const PlannerResult result = run.plan();
  CHECK(broken_promises(run, result) == kNothing);
  CHECK(result.grasps.empty());
  CHECK(result.stop == PlannerStop::Attempts);
  CHECK(result.statistics.outcomes.at(AttemptOutcome::NoTargets) == 5);
  CHECK(result.statistics.target_failures.at("no seed") == 5);
}

TEST_CASE("Objects of impossible size are refused with their extents and advice",
          "[grasp][grasp_planner]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  struct Case {
    double radius;
    const char* extent;  // This is the diameter in meters as its digits begin.
  };
  for (const Case& impossible : {Case{0.0005, "0.001"}, Case{5.0, "10"}}) {
    const geometry::TriangleMesh mesh = geometry::ball(impossible.radius);
    std::string message = "nothing thrown";
    try {
      grasp::prepare_object(mesh, hand, {});
    } catch (const base::InvalidInput& error) {
      message = error.what();
    }
    INFO("ball of radius " << impossible.radius);
    CHECK_THAT(message, Contains("--longest") && Contains("--mesh-unit"));
    CHECK_THAT(message, Contains(impossible.extent) || Contains("0.00099") || Contains("9.99"));
    CHECK_THAT(message, !Contains("\n"));
  }
}

}  // namespace

}  // namespace test_grasp_planner
