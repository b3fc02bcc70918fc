#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <vector>

#include "graspfit/contact/contact_estimation.hpp"
#include "graspfit/contact/epsilon_bound.hpp"
#include "graspfit/contact/wrench_convention.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace test_tried_starts {

namespace {

using namespace graspfit;
using namespace graspfit::grasp;

/// What an observer saw of a start; everything that must not outlive the call is copied.
struct Seen {
  std::int64_t attempt = 0;
  AttemptOutcome outcome = AttemptOutcome::NoTargets;
  std::size_t num_targets = 0;
  bool has_posture = false;
  std::optional<double> m;
  bool operator==(const Seen&) const = default;
};

PlannerOptions few_attempts() {
  PlannerOptions options;
  options.max_attempts = 4;
  options.count = 100;
  options.weak.reset();
  options.distinct = {.translation = 0.0, .rotation = 0.0, .joints = 0.0};
  return options;
}

struct Fixture {
  hands::HandModel hand = hands::find_hand("barrett");
  PlannerOptions options = few_attempts();
  ObjectModel object = prepare_object(geometry::capsule(0.03, 0.08), hand, options);

  PlannerResult plan(std::vector<Seen>& seen, int num_threads) const {
    std::mutex lock;
    PlanningRun run;
    run.num_threads = num_threads;
    run.tried_start = [&](const TriedStart& tried) {
      const std::lock_guard<std::mutex> guard(lock);
      seen.push_back({tried.attempt, tried.outcome, tried.start.targets.contacts.size(),
                      tried.start.posture.has_value(),
                      tried.grasp ? std::optional<double>(tried.grasp->quality.m) : std::nullopt});
    };
    return plan_grasps(object, hand, options, {}, run);
  }
};

}  // namespace

TEST_CASE("Every start that is tried is shown with what became of it", "[grasp][tried_starts]") {
  const Fixture fixture;
  std::vector<Seen> seen;
  const PlannerResult result = fixture.plan(seen, 1);
  REQUIRE(!seen.empty());
  std::map<std::int64_t, std::vector<Seen>> by_attempt;
  for (const Seen& start : seen) {
    by_attempt[start.attempt].push_back(start);
    CHECK(start.num_targets == 3);
    CHECK(start.has_posture);
    const bool has_grasp =
        start.outcome == AttemptOutcome::Valid || start.outcome == AttemptOutcome::UsableOnly;
    CHECK(start.m.has_value() == has_grasp);
  }
  // The first valid one is kept, and none after it is tried.
  for (const auto& [attempt, starts] : by_attempt) {
    CHECK(starts.size() <= static_cast<std::size_t>(fixture.options.max_placements));
    for (std::size_t i = 0; i + 1 < starts.size(); ++i) {
      // A valid one without a way in is followed by others.
      if (starts[i].outcome != AttemptOutcome::Valid) continue;
      CHECK(std::none_of(result.grasps.begin(), result.grasps.end(),
                         [attempt = attempt, m = starts[i].m](const Grasp& grasp) {
                           return grasp.attempt == attempt && grasp.quality.m == m;
                         }));
    }
  }
  for (const Grasp& grasp : result.grasps) {
    const std::vector<Seen>& starts = by_attempt.at(grasp.attempt);
    CHECK(std::any_of(starts.begin(), starts.end(),
                      [&](const Seen& start) { return start.m == grasp.quality.m; }));
  }
}

TEST_CASE("Looking on changes nothing, and several threads show the same starts",
          "[grasp][tried_starts]") {
  const Fixture fixture;
  std::vector<Seen> alone;
  const PlannerResult result = fixture.plan(alone, 1);
  std::vector<Seen> together;
  const PlannerResult same = fixture.plan(together, 2);
  std::stable_sort(together.begin(), together.end(),
                   [](const Seen& a, const Seen& b) { return a.attempt < b.attempt; });
  CHECK(together == alone);
  const PlannerResult unseen =
      plan_grasps(fixture.object, fixture.hand, fixture.options, {}, {.num_threads = 1});
  REQUIRE(unseen.grasps.size() == result.grasps.size());
  REQUIRE(same.grasps.size() == result.grasps.size());
  for (std::size_t i = 0; i < result.grasps.size(); ++i) {
    CHECK(unseen.grasps[i].configuration.q == result.grasps[i].configuration.q);
    CHECK(same.grasps[i].configuration.q == result.grasps[i].configuration.q);
  }
}

TEST_CASE("What an observer throws ends the run", "[grasp][tried_starts]") {
  const Fixture fixture;
  PlanningRun run;
  run.tried_start = [](const TriedStart&) { throw std::runtime_error("seen enough"); };
  CHECK_THROWS_WITH(plan_grasps(fixture.object, fixture.hand, fixture.options, {}, run),
                    "seen enough");
}

TEST_CASE("Starts that nobody tries are those that a run would try", "[grasp][tried_starts]") {
  Fixture fixture;
  fixture.options.kept = KeptCandidate::Strongest;
  fixture.options.candidate_order = CandidateOrder::Balance;
  fixture.options.max_placements = 24;
  fixture.options.max_attempts = 1;
  std::vector<Seen> tried;
  fixture.plan(tried, 1);
  std::size_t num_starts = 0;
  visit_starts(fixture.object, fixture.hand, fixture.options, 1, [&](const GuidedStart& start) {
    ++num_starts;
    CHECK(start.targets.contacts.size() == 3);
    CHECK(start.posture.has_value());
    CHECK(start.close != nullptr);
  });
  CHECK(num_starts == tried.size());
  CHECK(num_starts == 24);
  num_starts = 0;
  visit_starts(fixture.object, fixture.hand, fixture.options, 0,
               [&](const GuidedStart&) { ++num_starts; });
  CHECK(num_starts == 0);
}

/// Firmness of grasps on an object, with friction halfway between that of the options and of their
/// squeeze.
class Firmness {
 public:
  Firmness(const ObjectModel& object, const PlannerOptions& options)
      : object_(contact::wrench_object(object.mesh(), object.mass.center_of_mass)),
        largest_gap_(options.refinement.largest_gap),
        friction_(0.5 * (options.friction + options.squeeze_friction)) {}

  double operator()(const Grasp& grasp) const {
    const std::vector<contact::Contact> touching =
        contact::touching_contacts(grasp.contacts, largest_gap_);
    const contact::Wrenches wrenches = contact::contact_wrenches(
        touching,
        contact::wrench_convention(contact::WrenchTool::Graspfit, object_, touching, friction_));
    const double epsilon = contact::epsilon_bound(wrenches);
    return epsilon > 0.0 ? std::min(epsilon, 0.3 * contact::least_force(wrenches)) : epsilon;
  }

 private:
  const contact::WrenchObject object_;
  const double largest_gap_;
  const double friction_;
};

TEST_CASE("Attempts that keep the firmest grasp try no start that promises no more",
          "[grasp][tried_starts]") {
  const bool is_by_reach = GENERATE(true, false);
  const hands::HandModel hand = hands::find_hand("human_hand");
  PlannerOptions options = few_attempts();
  options.max_attempts = 1;
  options.kept = KeptCandidate::Firmest;
  options.friction = 0.5;
  options.squeeze_friction = 0.1;
  options.pre_grasps = false;  // What has no way in is not kept.
  if (is_by_reach) {
    options.targets.search = TargetSearch::Reach;
    options.style = GraspStyle::Auto;
  }
  const ObjectModel object = prepare_object(geometry::torus(0.05, 0.015, 48, 24), hand, options);
  const Firmness firmness(object, options);
  int num_later = 0;    // starts tried beside a grasp that is less firm
  int num_untried = 0;  // starts left out
  int num_kept = 0;
  int num_kept_firmest = 0;
  for (options.seed = 1; options.seed <= 16; ++options.seed) {
    CAPTURE(is_by_reach, options.seed);
    std::vector<std::optional<double>> promises;
    visit_starts(object, hand, options, 1, [&](const GuidedStart& start) {
      promises.push_back(start.promised_firmness);
      CHECK(start.promised_firmness.has_value() == is_by_reach);
    });
    std::vector<double> tried;  // firmness of valid grasps
    PlanningRun run;
    run.num_threads = 1;
    run.tried_start = [&](const TriedStart& start) {
      CHECK(start.start.promised_firmness == promises.at(tried.size()));
      tried.push_back(start.outcome == AttemptOutcome::Valid
                          ? firmness(*start.grasp)
                          : -std::numeric_limits<double>::infinity());
    };
    const PlannerResult result = plan_grasps(object, hand, options, {}, run);
    if (!is_by_reach) CHECK(tried.size() == promises.size());
    if (result.grasps.empty()) {
      CHECK(tried.size() == promises.size());
      continue;
    }
    const double kept = firmness(result.grasps[0]);
    ++num_kept;
    const double margin = 1e-12;
    num_kept_firmest += kept >= *std::max_element(tried.begin(), tried.end()) - margin ? 1 : 0;
    if (!is_by_reach) continue;
    double firmest = tried[0];
    for (std::size_t i = 1; i < promises.size(); ++i) {
      if (i >= tried.size()) {
        CHECK(kept >= *promises[i] - margin);
        ++num_untried;
        continue;
      }
      CHECK(firmest < *promises[i] + margin);
      num_later += std::isfinite(firmest) ? 1 : 0;
      firmest = std::max(firmest, tried[i]);
    }
  }
  CHECK(num_kept >= 8);
  CHECK(num_kept_firmest == num_kept);
  if (is_by_reach) {
    CHECK(num_untried > 0);
    CHECK(num_later > 0);
  }
}

TEST_CASE("Targets are drawn anew while no grasp of an attempt is firm", "[grasp][tried_starts]") {
  const double firm = 0.04;
  const int most = 4;
  const hands::HandModel hand = hands::find_hand("barrett");
  PlannerOptions options = few_attempts();
  options.max_attempts = 1;
  options.kept = KeptCandidate::Firmest;
  options.targets.search = TargetSearch::Reach;
  options.style = GraspStyle::Auto;
  const ObjectModel object =
      prepare_object(geometry::box(Eigen::Vector3d(0.03, 0.05, 0.14)), hand, options);
  const Firmness firmness(object, options);
  struct Made {
    std::vector<double> tried;
    std::optional<double> kept;
  };
  const auto made_with = [&](int redraws) {
    options.max_redraws = redraws;
    Made made;
    PlanningRun run;
    run.num_threads = 1;
    run.tried_start = [&](const TriedStart& start) {
      made.tried.push_back(start.grasp ? firmness(*start.grasp)
                                       : -std::numeric_limits<double>::infinity());
    };
    const PlannerResult result = plan_grasps(object, hand, options, {}, run);
    if (!result.grasps.empty()) made.kept = firmness(result.grasps[0]);
    return made;
  };
  int num_firm = 0;
  int num_redrawn = 0;
  int num_better = 0;
  for (options.seed = 1; options.seed <= 12; ++options.seed) {
    CAPTURE(options.seed);
    std::vector<Made> by_redraws;
    for (int redraws = 1; redraws <= most; ++redraws) by_redraws.push_back(made_with(redraws));
    for (std::size_t i = 1; i < by_redraws.size(); ++i) {
      CAPTURE(i);
      const Made& fewer = by_redraws[i - 1];
      const Made& more = by_redraws[i];
      // What fewer draws give comes first, and is not given up for less.
      REQUIRE(more.tried.size() >= fewer.tried.size());
      CHECK(std::equal(fewer.tried.begin(), fewer.tried.end(), more.tried.begin()));
      if (fewer.kept) CHECK(more.kept.value() >= *fewer.kept);
      if (fewer.kept && *fewer.kept >= firm) {
        CHECK(more.tried.size() == fewer.tried.size());
        ++num_firm;
      } else {
        num_redrawn += more.tried.size() > fewer.tried.size() ? 1 : 0;
        num_better += more.kept.value_or(-1.0) > fewer.kept.value_or(-1.0) ? 1 : 0;
      }
    }
  }
  CHECK(num_firm > 0);
  CHECK(num_redrawn > 0);
  CHECK(num_better > 0);
  // Other searches have no further draws.
  options.targets.search = TargetSearch::Random;
  options.style = GraspStyle::Precision;
  options.seed = 1;
  CHECK(made_with(most).tried == made_with(0).tried);
}

TEST_CASE("Hands are fitted to the first graze with refinement, and closed however far without",
          "[grasp][tried_starts]") {
  PlannerOptions options;
  options.fitting.contact_state = ContactState::Closed;
  CHECK(fitting_options(options).contact_state == ContactState::FirstGraze);
  CHECK(fitting_options(options).give_up_distance == options.fitting.give_up_distance);
  options.refine = false;
  CHECK(fitting_options(options).contact_state == ContactState::Closed);
  options.missing_contact = MissingContact::Measured;
  CHECK(fitting_options(options).give_up_distance > 1e300);
}

}  // namespace test_tried_starts
