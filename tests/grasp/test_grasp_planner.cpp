#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "grasp/target_oracle.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"

namespace {

using namespace graspfit;
using Catch::Contains;
using Eigen::Vector3d;
using grasp::Acceptance;
using grasp::AttemptOutcome;
using grasp::Grasp;
using grasp::PlannerOptions;
using grasp::PlannerResult;
using grasp::PlannerStop;
using grasp::SearchRule;
using testing::unsaid;

const std::vector<std::string> kNothing;

const std::vector<AttemptOutcome> kOutcomes = {
    AttemptOutcome::Valid,         AttemptOutcome::UsableOnly,
    AttemptOutcome::NoTargets,     AttemptOutcome::InitialCollision,
    AttemptOutcome::BlockedFinger, AttemptOutcome::MissedContact,
    AttemptOutcome::SelfCollision, AttemptOutcome::IterationLimit,
    AttemptOutcome::Unstable,      AttemptOutcome::PoorShape,
};

/// Every number of a grasp, written so that two are equal exactly if their bits are.
std::string all_fields(const Grasp& grasp) {
  std::ostringstream out;
  out << std::hexfloat;
  const auto vector = [&](const auto& values) {
    for (int i = 0; i < values.size(); ++i) out << values[i] << ' ';
    out << '\n';
  };
  const auto configuration = [&](const hands::HandConfiguration& c) {
    const Eigen::Matrix4d matrix = c.X_OH.matrix();
    vector(Eigen::Map<const Eigen::VectorXd>(matrix.data(), 16));
    vector(c.q);
  };
  configuration(grasp.configuration);
  for (const auto& optional : {grasp.pre_grasp, grasp.squeeze}) {
    out << optional.has_value() << '\n';
    if (optional) configuration(*optional);
  }
  out << grasp.targets.seeds_tried << '\n';
  for (const auto& target : grasp.targets.contacts) {
    vector(target.point_O);
    vector(target.outward_normal_O);
    out << target.patch << ' ' << target.score << ' ' << target.finger << '\n';
  }
  for (const auto& contact : grasp.contacts) {
    vector(contact.point_O);
    vector(contact.inward_normal_O);
    out << contact.area << ' ' << contact.pad_boundary_distance << ' ' << contact.gap << ' '
        << contact.link << ' ' << contact.pad << ' ' << contact.finger << ' ' << contact.is_target
        << ' ' << (contact.weak ? (*contact.weak ? "weak" : "strong") : "unknown") << '\n';
  }
  const grasp::ContactQuality& quality = grasp.quality;
  out << quality.m1 << ' ' << quality.m2 << ' ' << quality.m3 << ' ' << quality.m << ' '
      << quality.regularity << ' ' << quality.centroid_distance << ' '
      << quality.scaled_centroid_distance << '\n';
  for (const auto& term : quality.terms) {
    out << term.boundary_distance << ' ' << term.area << ' ' << term.strength << '\n';
  }
  for (const auto& pair : quality.stable_pairs) {
    out << pair.first << ' ' << pair.second << ' ' << pair.angle << '\n';
  }
  const grasp::GraspPenetration& penetration = grasp.penetration;
  out << grasp.ideal_m << ' ' << penetration.object_intersects << ' ' << penetration.object_depth
      << ' ' << penetration.object_depth_bound << ' ' << penetration.object_link << ' '
      << penetration.self_intersects << ' ' << penetration.self_depth << ' '
      << penetration.self_link_a << ' ' << penetration.self_link_b << ' ' << grasp.has_all_contacts
      << ' ' << grasp.attempt << ' ' << grasp.iterations << '\n';
  return out.str();
}

/// Everything of a result but its timings.
std::string all_fields(const PlannerResult& result) {
  std::ostringstream out;
  out << static_cast<int>(result.stop) << ' ' << result.statistics.attempts << '\n';
  for (const auto& [outcome, count] : result.statistics.outcomes) {
    out << grasp::outcome_name(outcome) << ' ' << count << '\n';
  }
  for (const auto& [name, count] : result.statistics.target_failures) {
    out << name << ' ' << count << '\n';
  }
  out << result.statistics.seeds_tried << ' ' << result.statistics.fitting_iterations << '\n';
  for (const Grasp& grasp : result.grasps) out << all_fields(grasp) << '\n';
  return out.str();
}

/// One object, the Barrett hand and what is planned.
struct Run {
  Run(const geometry::TriangleMesh& mesh, PlannerOptions planner_options)
      : options(std::move(planner_options)),
        hand(hands::find_hand("barrett")),
        object(grasp::prepare_object(mesh, hand, options)),
        collision(hand) {}

  PlannerResult plan() const { return grasp::plan_grasps(object, hand, options); }

  PlannerOptions options;
  hands::HandModel hand;
  grasp::ObjectModel object;
  hands::HandCollision collision;
};

/// The narrower side of the pad's outline in its own frame: one pad width [m].
double pad_width(const hands::ContactPad& pad) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : pad.outline) box.extend(corner);
  return box.sizes().minCoeff();
}

/// The finger that a link belongs to; −1 for the palm and for no link.
int finger_of_link(const hands::HandModel& hand, int link) {
  for (std::size_t i = 0; i < hand.fingers.size(); ++i) {
    const std::vector<int>& links = hand.fingers[i].links;
    if (std::find(links.begin(), links.end(), link) != links.end()) return static_cast<int>(i);
  }
  return -1;
}

/// All that has to hold of a planner's result, one line for each thing that does not.
std::vector<std::string> broken_promises(const Run& run, const PlannerResult& result) {
  std::vector<std::string> broken;
  const auto report = [&](const auto&... parts) {
    std::ostringstream line;
    line.precision(17);
    (line << ... << parts);
    broken.push_back(line.str());
  };
  const PlannerOptions& options = run.options;
  const hands::HandModel& hand = run.hand;
  const double voxel_size = run.object.grid.lattice.voxel_size;

  // Statistics.
  const grasp::PlannerStatistics& statistics = result.statistics;
  std::int64_t sum = 0;
  for (const AttemptOutcome outcome : kOutcomes) {
    if (!statistics.outcomes.contains(outcome)) {
      report("no count of ", grasp::outcome_name(outcome));
    } else {
      sum += statistics.outcomes.at(outcome);
    }
  }
  if (statistics.outcomes.size() != kOutcomes.size()) report("outcomes beyond those there are");
  if (sum != statistics.attempts) report("outcomes ", sum, " of attempts ", statistics.attempts);
  if (statistics.attempts > options.max_attempts) report("attempts: ", statistics.attempts);
  const auto count_of = [&](AttemptOutcome outcome) {
    const auto found = statistics.outcomes.find(outcome);
    return found == statistics.outcomes.end() ? 0 : found->second;
  };
  if (statistics.valid() != count_of(AttemptOutcome::Valid)) report("valid()");
  if (statistics.usable() !=
      count_of(AttemptOutcome::Valid) + count_of(AttemptOutcome::UsableOnly)) {
    report("usable()");
  }
  std::int64_t target_failures = 0;
  for (const auto& [name, count] : statistics.target_failures) {
    if (name != "no seed" && name != "no second" && name != "no further") report("failure ", name);
    target_failures += count;
  }
  if (target_failures != count_of(AttemptOutcome::NoTargets)) report("sum of target failures");

  // Number and order of grasps.
  const std::int64_t num_grasps = static_cast<std::int64_t>(result.grasps.size());
  if (num_grasps > options.count) report(num_grasps, " grasps of ", options.count);
  if (result.stop == PlannerStop::WallClock) report("stopped by the clock");
  const bool used_all = statistics.attempts == options.max_attempts;
  if (options.search == SearchRule::Best && (!used_all || result.stop != PlannerStop::Attempts)) {
    report("stopped before all attempts: ", statistics.attempts);
  }
  if (result.stop == PlannerStop::Count && num_grasps != options.count) {
    report("stopped with ", num_grasps, " grasps of ", options.count);
  }
  if (result.stop == PlannerStop::Attempts && !used_all) {
    report("stopped by attempts after ", statistics.attempts);
  }
  if (options.search == SearchRule::First && result.stop == PlannerStop::Attempts &&
      num_grasps == options.count) {
    report("had its grasps and went on");
  }
  const std::int64_t num_acceptable = std::min<std::int64_t>(
      options.count,
      options.acceptance == Acceptance::Valid ? statistics.valid() : statistics.usable());
  if (options.acceptance == Acceptance::Quality ? num_grasps > num_acceptable
                                                : num_grasps != num_acceptable) {
    report(num_grasps, " grasps, statistics say ", num_acceptable);
  }
  for (std::size_t i = 1; i < result.grasps.size(); ++i) {
    const Grasp &a = result.grasps[i - 1], &b = result.grasps[i];
    if (a.quality.m < b.quality.m || (a.quality.m == b.quality.m && a.attempt >= b.attempt)) {
      report("grasp ", i, " is out of order");
    }
  }

  // Each grasp.
  const std::vector<int> fingers = grasp::requested_fingers(hand, options);
  const hands::TipDistances distances = hands::tip_distances(hand);
  grasp::TargetOptions target_options = options.targets;
  if (target_options.min_separation == 0.0) {
    target_options.min_separation = std::numeric_limits<double>::infinity();
    for (const int finger : fingers) {
      target_options.min_separation = std::min(target_options.min_separation,
                                               pad_width(hand.pads[hand.fingers[finger].tip_pad]));
    }
  }
  grasp::ContactEstimationOptions contact_options;
  contact_options.clip_thickness = grasp::clip_thickness(options, voxel_size);
  contact_options.averaging = options.averaging;
  grasp::QualityOptions quality_options = options.quality;
  if (quality_options.merge_distance == 0.0) quality_options.merge_distance = 0.1 * voxel_size;
  grasp::QualityContext context;
  context.center_of_mass_O = run.object.mass.center_of_mass;
  context.normalizing_radius = run.object.normalizing_radius;
  context.hand = &hand;

  std::set<std::int64_t> attempts;
  for (std::size_t i = 0; i < result.grasps.size(); ++i) {
    const Grasp& g = result.grasps[i];
    const auto wrong = [&](const auto&... parts) { report("grasp ", i, ": ", parts...); };
    if (!attempts.insert(g.attempt).second) wrong("attempt ", g.attempt, " twice");
    if (g.attempt < 0 || g.attempt > statistics.attempts) wrong("attempt ", g.attempt);
    if (g.iterations < 0 || g.iterations > options.fitting.max_iterations) {
      wrong("iterations ", g.iterations);
    }

    // Acceptance.
    if (!(g.quality.m > 0.0) || !g.is_usable()) wrong("not usable");
    if (options.acceptance == Acceptance::Valid && !g.is_valid()) wrong("not valid");
    if (options.acceptance == Acceptance::Quality && g.quality.m < std::min(0.5 * g.ideal_m, 0.6)) {
      wrong("M ", g.quality.m, " with ideal ", g.ideal_m);
    }
    if (!(g.ideal_m > 0.0)) wrong("ideal M ", g.ideal_m);

    // Targets.
    for (const std::string& line :
         testing::broken_requirements(run.object, distances, fingers, target_options, g.targets)) {
      wrong(line);
    }
    std::vector<int> assigned;
    for (const auto& target : g.targets.contacts) assigned.push_back(target.finger);
    if (!std::is_permutation(assigned.begin(), assigned.end(), fingers.begin(), fingers.end())) {
      wrong("targets are not one for each finger");
    }
    if (!assigned.empty() && assigned.front() != fingers.front()) wrong("seed's finger");

    // Configuration.
    try {
      hands::validate(hand, g.configuration);
    } catch (const geometry::InvalidInput& error) {
      wrong(error.what());
    }
    const Vector3d direction = g.configuration.X_OH.linear() * hand.palm.direction_H;
    if (options.approach_O && direction.dot(*options.approach_O) <= 0.0) wrong("approach");

    // Exact penetration.
    const auto X_OL = hands::forward_kinematics(hand, g.configuration);
    const auto with_object = run.collision.against_object(run.object.query, X_OL);
    const auto with_itself = run.collision.against_self(X_OL);
    if (with_object.intersects != g.penetration.object_intersects) wrong("object_intersects");
    if (with_itself.intersects != g.penetration.self_intersects) wrong("self_intersects");
    if (with_object.depth != g.penetration.object_depth) wrong("object_depth");
    if (with_itself.depth != g.penetration.self_depth) wrong("self_depth");
    // Notes 25: penetration below one voxel; A40: overlap of fingers below the limit.
    if (with_object.depth_bound >= voxel_size * std::sqrt(3.0)) {
      wrong("cuts ", with_object.depth, " into the object");
    }
    const int finger_a = finger_of_link(hand, with_itself.link_a);
    const int finger_b = finger_of_link(hand, with_itself.link_b);
    if (finger_a >= 0 && finger_b >= 0 && finger_a != finger_b &&
        with_itself.depth > options.self_overlap) {
      wrong("fingers overlap by ", with_itself.depth);
    }
    if (g.is_valid() && (with_object.intersects || with_itself.intersects)) wrong("not valid");

    // Contacts and measure from the meshes alone.
    bool has_all = true;
    for (const int finger : fingers) {
      has_all = has_all && std::any_of(g.contacts.begin(), g.contacts.end(),
                                       [&](const auto& c) { return c.finger == finger; });
    }
    if (g.has_all_contacts && !has_all) wrong("a requested finger has no contact");
    const Grasp again =
        grasp::measure_grasp(hand, run.collision, run.object.query, context, g.configuration,
                             fingers, contact_options, quality_options);
    const auto compare = [&](const char* name, double a, double b) {
      if (!(std::abs(a - b) <= 1e-12)) wrong(name, ": ", a, ", measured again ", b);
    };
    compare("m1", g.quality.m1, again.quality.m1);
    compare("m2", g.quality.m2, again.quality.m2);
    compare("m3", g.quality.m3, again.quality.m3);
    compare("m", g.quality.m, again.quality.m);
    compare("regularity", g.quality.regularity, again.quality.regularity);
    compare("centroid distance", g.quality.centroid_distance, again.quality.centroid_distance);
    if (g.has_all_contacts != again.has_all_contacts) wrong("has_all_contacts, measured again");
    if (g.is_valid() != again.is_valid()) wrong("is_valid, measured again");
    if (g.contacts.size() != again.contacts.size()) {
      wrong(g.contacts.size(), " contacts, measured again ", again.contacts.size());
    } else {
      for (std::size_t k = 0; k < g.contacts.size(); ++k) {
        if ((g.contacts[k].point_O - again.contacts[k].point_O).norm() > 1e-12 ||
            g.contacts[k].pad != again.contacts[k].pad) {
          wrong("contact ", k, ", measured again");
        }
      }
    }
    // The measure of the contacts that are stored, computed directly.
    const auto direct = grasp::contact_quality(g.contacts, context, quality_options);
    compare("m of the stored contacts", g.quality.m, direct.m);
  }
  return broken;
}

/// Stops at the first `count` grasps.
PlannerOptions collecting(Acceptance acceptance, int count, int max_attempts) {
  PlannerOptions options;
  options.search = SearchRule::First;
  options.acceptance = acceptance;
  options.count = count;
  options.max_attempts = max_attempts;
  options.search = SearchRule::First;
  return options;
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
// What is returned

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
  const bool as_published = GENERATE(false, true);
  for (const NamedMesh& shape : shapes()) {
    PlannerOptions options = collecting(Acceptance::Usable, 1000, 6);
    if (as_published) {
      options.fitting.guard = grasp::PenetrationGuard::Voxels;
      options.fitting.settle = false;
    }
    INFO(shape.name << (as_published ? ", guarded by voxels" : ", guarded by meshes, settled"));
    const Run run(shape.mesh, options);
    const PlannerResult result = run.plan();
    CHECK(result.stop == PlannerStop::Attempts);
    CHECK(broken_promises(run, result) == kNothing);
    CHECK(static_cast<std::int64_t>(result.grasps.size()) == result.statistics.usable());
  }
}

TEST_CASE("High-quality grasps reach half the ideal measure or 0.6", "[grasp][grasp_planner]") {
  const Run run(geometry::ball(0.05), collecting(Acceptance::Quality, 3, 60));
  const PlannerResult result = run.plan();
  CHECK(broken_promises(run, result) == kNothing);
  CHECK_FALSE(result.grasps.empty());
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

TEST_CASE("Progress is told after every attempt", "[grasp][grasp_planner]") {
  const Run run(geometry::ball(0.05), collecting(Acceptance::Usable, 2, 30));
  std::vector<std::pair<std::int64_t, std::int64_t>> calls;
  const PlannerResult result = grasp::plan_grasps(
      run.object, run.hand, run.options,
      [&](std::int64_t attempts, std::int64_t grasps) { calls.emplace_back(attempts, grasps); });
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

// ---------------------------------------------------------------------------------------------
// Reproducibility

TEST_CASE("The same seed gives the same bytes, another seed another result",
          "[grasp][grasp_planner]") {
  const geometry::TriangleMesh mesh = geometry::torus(0.05, 0.018);
  PlannerOptions options = collecting(Acceptance::Usable, 1000, 4);
  const Run run(mesh, options);
  const std::string once = all_fields(run.plan());
  CHECK(once == all_fields(run.plan()));
  CHECK(once == all_fields(Run(mesh, options).plan()));  // everything prepared anew
  options.seed = 2;
  const Run other(mesh, options);
  CHECK(once != all_fields(other.plan()));
}

TEST_CASE("An attempt's grasp depends on the seed and its number alone", "[grasp][grasp_planner]") {
  // Asking for fewer grasps, or accepting fewer, changes which are returned and not what they are.
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

TEST_CASE("A turned object is grasped as often", "[grasp][grasp_planner]") {
  constexpr int kAttempts = 20;
  const geometry::TriangleMesh mesh = geometry::box(Vector3d(0.10, 0.06, 0.08));
  geometry::RigidTransform X_WO = geometry::RigidTransform::Identity();
  X_WO.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // 90° about z, exactly
  const auto usable_of = [&](const geometry::TriangleMesh& turned) {
    return static_cast<double>(
        Run(turned, collecting(Acceptance::Usable, 1000, kAttempts)).plan().statistics.usable());
  };
  const double plain = usable_of(mesh), turned = usable_of(geometry::transformed(mesh, X_WO));
  // Both are counts out of 20 with the same chance, so their difference has a standard deviation of
  // at most sqrt(2 · 20 / 4) = 3.2; four of them.
  INFO(plain << " and " << turned << " of " << kAttempts);
  CHECK(std::abs(plain - turned) <= 13.0);
  CHECK(plain > 0.0);
  CHECK(turned > 0.0);
}

// ---------------------------------------------------------------------------------------------
// Failures

TEST_CASE("A threshold that no voxel exceeds is reported as no seed", "[grasp][grasp_planner]") {
  PlannerOptions options = collecting(Acceptance::Valid, 1, 5);
  options.targets.score_threshold = 0.999999;  // a ball's scores are near 0.8 everywhere
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
    const char* extent;  // the diameter in meters as its digits begin
  };
  for (const Case& impossible : {Case{0.0005, "0.001"}, Case{5.0, "10"}}) {
    const geometry::TriangleMesh mesh = geometry::ball(impossible.radius);
    std::string message = "nothing thrown";
    try {
      const grasp::ObjectModel object = grasp::prepare_object(mesh, hand, {});
      grasp::plan_grasps(object, hand, {});
    } catch (const geometry::InvalidInput& error) {
      message = error.what();
    }
    INFO("ball of radius " << impossible.radius);
    CHECK_THAT(message, Contains("--longest") && Contains("--mesh-unit"));
    CHECK_THAT(message, Contains(impossible.extent) || Contains("0.00099") || Contains("9.99"));
    CHECK_THAT(message, !Contains("\n"));
  }
}

// ---------------------------------------------------------------------------------------------
// Options

std::string message_of(const PlannerOptions& options) {
  try {
    options.validate();
  } catch (const geometry::InvalidInput& error) {
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
  // Options inside options.
  CHECK(unsaid(message_after([](auto& o) { o.score.neighborhood = 4; }), "neighborhood", "4") ==
        "");
  CHECK(unsaid(message_after([](auto& o) { o.targets.score_threshold = 1.5; }), "score_threshold",
               "1.5") == "");
  CHECK(unsaid(message_after([](auto& o) { o.fitting.small_step = -0.5; }), "small_step", "-0.5") ==
        "");
  CHECK(unsaid(message_after([](auto& o) { o.quality.theta_max = 1.75; }), "theta_max", "1.75") ==
        "");
}

TEST_CASE("Planning checks its options before it works", "[grasp][grasp_planner]") {
  Run run(geometry::ball(0.05), {});
  run.options.count = 0;
  CHECK_THROWS_AS(run.plan(), geometry::InvalidInput);
  run.options = {};
  run.options.targets.max_seeds = 0;
  CHECK_THROWS_AS(run.plan(), geometry::InvalidInput);
  run.options = {};
  run.options.fingers = {"thumb", "finger_9"};
  CHECK_THROWS_WITH(run.plan(), Contains("finger_9") && Contains("finger_1"));
  run.options = {};
  run.options.num_contacts = 4;
  CHECK_THROWS_AS(run.plan(), geometry::InvalidInput);
  run.options = {};
  run.options.fingers = {"thumb"};  // N ≥ 2
  CHECK_THROWS_AS(run.plan(), geometry::InvalidInput);
}

TEST_CASE("The thumb comes first where it is among the fingers asked for",
          "[grasp][grasp_planner]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const int thumb = hand.thumb();
  const int finger_1 = hand.finger_index("finger_1"), finger_2 = hand.finger_index("finger_2");
  const auto requested = [&](std::vector<std::string> names) {
    PlannerOptions options;
    options.fingers = std::move(names);
    return grasp::requested_fingers(hand, options);
  };
  CHECK(requested({"thumb", "finger_1", "finger_2"}) ==
        std::vector<int>{thumb, finger_1, finger_2});
  CHECK(requested({"finger_1", "finger_2", "thumb"}) ==
        std::vector<int>{thumb, finger_1, finger_2});
  CHECK(requested({"finger_2", "thumb"}) == std::vector<int>{thumb, finger_2});
  CHECK(requested({"finger_2", "finger_1"}) == std::vector<int>{finger_2, finger_1});

  PlannerOptions options;
  options.num_contacts = 3;
  const std::vector<int> three = grasp::requested_fingers(hand, options);
  CHECK(three.size() == 3);
  CHECK(three.front() == thumb);
  CHECK(std::set<int>(three.begin(), three.end()).size() == 3);
  options.num_contacts = 2;
  const std::vector<int> two = grasp::requested_fingers(hand, options);
  CHECK(two.size() == 2);
  CHECK(two.front() == thumb);
  CHECK(two.back() != thumb);

  options.num_contacts = 4;
  CHECK_THROWS_WITH(grasp::requested_fingers(hand, options), Contains("4") && Contains("3"));
  CHECK_THROWS_AS(requested({"thumb", "thumb"}), geometry::InvalidInput);
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

TEST_CASE("The object is prepared with the resolution asked for, alike for every hand",
          "[grasp][grasp_planner]") {
  const hands::HandModel hand = hands::find_hand("barrett");
  const geometry::TriangleMesh mesh = geometry::box(Vector3d(0.10, 0.06, 0.08));
  for (const int resolution : {12, 30}) {
    PlannerOptions options;
    options.resolution = resolution;
    const grasp::ObjectModel object = grasp::prepare_object(mesh, hand, options);
    const geometry::VoxelLattice& lattice = object.grid.lattice;
    CHECK(lattice.voxel_size == Approx(0.10 / resolution).epsilon(1e-12));
    CHECK(lattice.counts.x() == resolution + 2 * grasp::kRoomVoxels);
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

// ---------------------------------------------------------------------------------------------
// Measuring a configuration

TEST_CASE("A hand far from the object has no contact, no measure and no penetration",
          "[grasp][grasp_planner]") {
  const Run run(geometry::ball(0.05), {});
  grasp::QualityContext context;
  context.center_of_mass_O = run.object.mass.center_of_mass;
  context.normalizing_radius = run.object.normalizing_radius;
  context.hand = &run.hand;
  grasp::ContactEstimationOptions contact_options;
  contact_options.clip_thickness = 0.001;
  hands::HandConfiguration configuration = hands::open_configuration(run.hand);
  const std::vector<int> fingers = grasp::requested_fingers(run.hand, {});
  const auto measure_at = [&](const Vector3d& position) {
    configuration.X_OH.translation() = position;
    return grasp::measure_grasp(run.hand, run.collision, run.object.query, context, configuration,
                                fingers, contact_options, {});
  };
  const Grasp away = measure_at(Vector3d(0, 0, -1));
  CHECK(away.contacts.empty());
  CHECK(away.quality.m == 0.0);
  CHECK_FALSE(away.has_all_contacts);
  CHECK_FALSE(away.penetration.object_intersects);
  CHECK(away.penetration.object_depth == 0.0);
  CHECK_FALSE(away.is_valid());

  // The ball's center in the palm's surface: half the ball is in the palm's side of it.
  const Grasp inside = measure_at(Vector3d(0, 0, 0));
  CHECK(inside.penetration.object_intersects);
  CHECK(inside.penetration.object_depth > 0.01);
  CHECK(inside.penetration.object_depth_bound >= inside.penetration.object_depth);
  CHECK_FALSE(inside.is_valid());
}

}  // namespace
