#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "grasp/target_oracle.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/grasp/grasp_measure.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_library.hpp"

/// \file
/// Runs the planner, and checks every bit of what it returns, and all that must hold of it.

namespace graspfit::testing {

using Eigen::Vector3d;
using grasp::Acceptance;
using grasp::AttemptOutcome;
using grasp::CandidateOrder;
using grasp::Grasp;
using grasp::KeptCandidate;
using grasp::PlannerOptions;
using grasp::PlannerResult;
using grasp::PlannerStop;
using grasp::SearchRule;

inline const std::vector<std::string> kNothing;

inline const std::vector<AttemptOutcome> kOutcomes = {
    AttemptOutcome::Valid,          AttemptOutcome::UsableOnly,
    AttemptOutcome::NoTargets,      AttemptOutcome::InitialCollision,
    AttemptOutcome::BlockedFinger,  AttemptOutcome::MissedContact,
    AttemptOutcome::GapLeft,        AttemptOutcome::SelfCollision,
    AttemptOutcome::Rejected,       AttemptOutcome::NoWayIn,
    AttemptOutcome::IterationLimit, AttemptOutcome::Weak,
    AttemptOutcome::Unstable,       AttemptOutcome::PoorShape,
};

/// Returns every number of a grasp, written so that two texts are equal exactly if the bits are.
inline std::string all_fields(const Grasp& grasp) {
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
  out << grasp.pre_grasp.has_value() << ' ' << grasp.squeeze.has_value() << '\n';
  if (grasp.pre_grasp) {
    configuration(grasp.pre_grasp->configuration);
    out << grasp.pre_grasp->clearance << ' ' << grasp.pre_grasp->opening << ' '
        << grasp.pre_grasp->retreat << '\n';
  }
  if (grasp.squeeze) {
    configuration(grasp.squeeze->configuration);
    vector(grasp.squeeze->forces_O.reshaped());
    out << grasp.squeeze->residual << ' ' << grasp.squeeze->is_balanced << '\n';
  }
  out << grasp.epsilon() << ' ' << (grasp.wrench ? grasp.wrench->volume : 0.0) << ' '
      << (grasp.wrench ? grasp.wrench->rank : 0) << '\n';
  out << grasp.targets.seeds_tried << '\n';
  for (const auto& target : grasp.targets.contacts) {
    vector(target.point_O);
    vector(target.outward_normal_O);
    out << target.patch.value_or(-1) << ' ' << target.score << ' ' << target.is_palm << ' '
        << target.finger.value_or(-1) << '\n';
  }
  for (const auto& contact : grasp.contacts) {
    vector(contact.point_O);
    vector(contact.inward_normal_O);
    out << contact.area << ' ' << contact.pad_boundary_distance << ' ' << contact.gap << ' '
        << contact.link << ' ' << contact.pad.value_or(-1) << ' ' << contact.finger.value_or(-1)
        << ' ' << contact.is_target << ' '
        << (contact.weak ? (*contact.weak ? "weak" : "strong") : "unknown") << '\n';
  }
  const contact::ContactQuality& quality = grasp.quality;
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
      << ' ' << penetration.object_depth_bound << ' ' << penetration.object_link.value_or(-1) << ' '
      << penetration.self_intersects << ' ' << penetration.self_depth << ' '
      << penetration.self_link_a.value_or(-1) << ' ' << penetration.self_link_b.value_or(-1) << ' '
      << grasp.has_all_contacts << ' ' << grasp.attempt << ' ' << grasp.iterations << ' '
      << grasp.refinement_iterations << '\n';
  return out.str();
}

/// Returns everything of a result but its timings.
inline std::string all_fields(const PlannerResult& result) {
  std::ostringstream out;
  out << static_cast<int>(result.stop) << ' ' << result.statistics.attempts << '\n';
  for (const auto& [outcome, count] : result.statistics.outcomes) {
    out << grasp::outcome_name(outcome) << ' ' << count << '\n';
  }
  for (const auto& [name, count] : result.statistics.target_failures) {
    out << name << ' ' << count << '\n';
  }
  for (const auto& [name, count] : result.statistics.guidance) out << name << ' ' << count << '\n';
  out << result.statistics.seeds_tried << ' ' << result.statistics.fitting_iterations << ' '
      << result.statistics.refinement_iterations << ' ' << result.statistics.duplicates << '\n';
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

  PlannerResult plan(int num_threads = 0) const {
    return grasp::plan_grasps(object, hand, options, surroundings, {.num_threads = num_threads});
  }

  PlannerOptions options;
  hands::HandModel hand;
  grasp::ObjectModel object;
  hands::HandCollision collision;
  grasp::Surroundings surroundings;
};

/// Returns the scene with which `run` measures.
inline grasp::MeasuringScene measuring_scene(const Run& run,
                                             const grasp::SurroundingsCollision& surroundings) {
  const double voxel_size = run.object.grid.lattice.voxel_size;
  grasp::MeasuringScene scene{
      .hand = run.hand,
      .collision = run.collision,
      .object = run.object.query,
      .surroundings = surroundings,
      .weak = run.object.weak ? &*run.object.weak : nullptr,
      .wrench_object = contact::wrench_object(run.object.mesh(), run.object.mass.center_of_mass),
      .friction = run.options.friction,
      .quality_context = {run.object.mass.center_of_mass, run.object.normalizing_radius, &run.hand},
      .quality_options = run.options.quality,
      .contact_options =
          grasp::contact_estimation(run.options, grasp::clip_thickness(run.options, voxel_size))};
  scene.quality_options.merge_distance = grasp::merge_distance(run.options, voxel_size);
  if (run.options.refine) {
    scene.largest_gap = scene.bearing_gap = run.options.refinement.largest_gap;
  }
  return scene;
}

/// Returns the narrower side of the pad's outline in its own frame: one pad width [m].
inline double pad_width(const hands::ContactPad& pad) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : pad.outline) box.extend(corner);
  return box.sizes().minCoeff();
}

/// Returns the finger that a link belongs to; −1 for the palm and for no link.
inline int finger_of_link(const hands::HandModel& hand, std::optional<int> link) {
  for (std::size_t i = 0; i < hand.fingers.size(); ++i) {
    const std::vector<int>& links = hand.fingers[i].links;
    if (std::find(links.begin(), links.end(), link) != links.end()) return static_cast<int>(i);
  }
  return -1;
}

/// Returns all that has to hold of a planner's result and does not, one line for each.
inline std::vector<std::string> broken_promises(const Run& run, const PlannerResult& result) {
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

  const bool has_targets = options.planner == "fitting" || options.planner == "gs-targets";
  const bool are_chosen = options.planner == "fitting";

  // These lines check the statistics.
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
    const bool is_of_fitting =
        name == "no seed" || name == "no second" || name == "no further" || name == "no palm";
    if (are_chosen ? !is_of_fitting
                   : name != "no sample" && name != "no candidate" && name != "no set") {
      report("failure ", name);
    }
    target_failures += count;
  }
  if (target_failures != count_of(AttemptOutcome::NoTargets)) report("sum of target failures");

  // These lines check number and order of grasps.
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
  const auto num_wanted =
      std::count_if(result.grasps.begin(), result.grasps.end(), [&](const Grasp& grasp) {
        return options.search != SearchRule::Closed || grasp.is_closed();
      });
  if (options.search != SearchRule::Best &&
      (num_wanted == options.count) != (result.stop == PlannerStop::Count)) {
    report("stopped with ", num_wanted, " grasps that count of ", options.count);
  }
  const std::int64_t num_acceptable = std::min<std::int64_t>(
      options.count,
      (options.acceptance == Acceptance::Valid ? statistics.valid() : statistics.usable()) -
          statistics.duplicates);
  if (num_grasps != num_acceptable) {
    report(num_grasps, " grasps, statistics say ", num_acceptable);
  }
  for (std::size_t i = 1; i < result.grasps.size(); ++i) {
    const Grasp &a = result.grasps[i - 1], &b = result.grasps[i];
    const bool is_of_one_kind =
        options.search != SearchRule::Closed || a.is_closed() == b.is_closed();
    if (is_of_one_kind
            ? a.quality.m < b.quality.m || (a.quality.m == b.quality.m && a.attempt >= b.attempt)
            : b.is_closed()) {
      report("grasp ", i, " is out of order");
    }
  }

  // These lines check each grasp.
  const grasp::RequestedParts parts = grasp::requested_parts(hand, options);
  const std::vector<int>& fingers = parts.fingers;
  const grasp::PartDistances distances = grasp::part_distances(hand);
  grasp::TargetOptions target_options = options.targets;
  if (!target_options.min_separation) {
    double least_width = std::numeric_limits<double>::infinity();
    for (const int finger : fingers) {
      least_width = std::min(least_width, pad_width(hand.pads[*hand.fingers[finger].tip_pad]));
    }
    target_options.min_separation = least_width;
  }
  const grasp::SurroundingsCollision surroundings(hand, run.surroundings);
  const grasp::MeasuringScene scene = measuring_scene(run, surroundings);

  std::set<std::int64_t> attempts;
  for (std::size_t i = 0; i < result.grasps.size(); ++i) {
    const Grasp& g = result.grasps[i];
    const auto wrong = [&](const auto&... words) { report("grasp ", i, ": ", words...); };
    if (!attempts.insert(g.attempt).second) wrong("attempt ", g.attempt, " twice");
    if (g.attempt < 0 || g.attempt > statistics.attempts) wrong("attempt ", g.attempt);
    if (g.iterations < 0 || g.iterations > options.fitting.max_iterations) {
      wrong("iterations ", g.iterations);
    }

    // These lines check whether the grasp is accepted.
    if (!(g.quality.m > 0.0) || !g.is_usable()) wrong("not usable");
    if (options.acceptance == Acceptance::Valid && !g.is_valid()) wrong("not valid");
    const double least_m = has_targets ? std::min(0.5 * g.ideal_m, 0.6) : 0.6;
    if (options.rejection == grasp::Rejection::Quality && g.quality.m < least_m) {
      wrong("M ", g.quality.m, " with ideal ", g.ideal_m);
    }
    if (options.rejection == grasp::Rejection::Deviation) {
      for (const auto& target : g.targets.contacts) {
        const bool is_near =
            std::any_of(g.contacts.begin(), g.contacts.end(), [&](const contact::Contact& contact) {
              return grasp::is_for_part_of(target, contact) && contact.is_target &&
                     (contact.point_O - target.point_O).norm() <= *options.largest_deviation;
            });
        if (!is_near) wrong("no contact near the target of finger ", target.finger.value_or(-1));
      }
    }
    if (has_targets ? !(g.ideal_m > 0.0) : g.ideal_m != 0.0) wrong("ideal M ", g.ideal_m);

    // These lines check its targets.
    if (!has_targets && !g.targets.contacts.empty()) wrong("targets of a method without");
    for (const std::string& line :
         are_chosen
             ? testing::broken_requirements(run.object, distances, parts, target_options, g.targets)
             : kNothing) {
      wrong(line);
    }
    std::vector<int> assigned;
    for (const auto& target : g.targets.contacts) assigned.push_back(target.finger.value_or(-1));
    if (has_targets &&
        !std::is_permutation(assigned.begin(), assigned.end(), fingers.begin(), fingers.end())) {
      wrong("targets are not one for each finger");
    }
    if (!assigned.empty() && assigned.front() != fingers.front()) wrong("seed's finger");

    // These lines check its configuration.
    try {
      hands::validate(hand, g.configuration);
    } catch (const base::InvalidInput& error) {
      wrong(error.what());
    }
    const Vector3d direction = g.configuration.X_OH.linear() * hand.palm.direction_H;
    if (options.approach_O && direction.dot(*options.approach_O) <= 0.0) wrong("approach");

    // These lines check penetration exactly.
    const auto X_OL = hands::forward_kinematics(hand, g.configuration);
    const auto with_object = run.collision.against_object(run.object.query, X_OL);
    const auto with_itself = run.collision.against_self(X_OL);
    if (with_object.intersects != g.penetration.object_intersects) wrong("object_intersects");
    if (with_itself.intersects != g.penetration.self_intersects) wrong("self_intersects");
    if (with_object.depth != g.penetration.object_depth) wrong("object_depth");
    if (with_itself.depth != g.penetration.self_depth) wrong("self_depth");
    // Penetration is below one voxel, overlap of fingers below the limit.
    if (with_object.depth_bound >= voxel_size * std::sqrt(3.0)) {
      wrong("cuts ", with_object.depth, " into the object");
    }
    const int finger_a = finger_of_link(hand, with_itself.link_a);
    const int finger_b = finger_of_link(hand, with_itself.link_b);
    if (finger_a >= 0 && finger_b >= 0 && finger_a != finger_b &&
        with_itself.depth > options.self_overlap) {
      wrong("fingers overlap by ", with_itself.depth);
    }
    if (options.refine) {
      // Refinement promises real contact everywhere, and exactly nothing inside.
      if (with_object.intersects || with_itself.intersects) wrong("refined, but intersecting");
      for (const auto& contact : g.contacts) {
        if (contact.is_target && contact.gap > options.refinement.largest_gap) {
          wrong("gap of ", contact.gap, " at pad ", *contact.pad);
        }
      }
      if (!g.pre_grasp) wrong("no way in");
    }
    if (g.is_valid() && (with_object.intersects || with_itself.intersects)) wrong("not valid");

    // These lines check contacts and measure from the meshes alone.
    bool has_all = true;
    for (const int finger : fingers) {
      has_all = has_all && std::any_of(g.contacts.begin(), g.contacts.end(),
                                       [&](const auto& c) { return c.finger == finger; });
    }
    if (g.has_all_contacts && !has_all) wrong("a requested finger has no contact");
    const Grasp again = grasp::measure_grasp(scene, g.configuration, parts);
    const auto compare = [&](const char* name, double a, double b) {
      if (!(std::abs(a - b) <= 1e-12)) wrong(name, ": ", a, ", measured again ", b);
    };
    compare("m1", g.quality.m1, again.quality.m1);
    compare("m2", g.quality.m2, again.quality.m2);
    compare("m3", g.quality.m3, again.quality.m3);
    compare("m", g.quality.m, again.quality.m);
    compare("epsilon", g.epsilon(), again.epsilon());
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
    // The measure of the contacts that are stored is computed directly.
    const auto direct =
        contact::contact_quality(g.contacts, scene.quality_context, scene.quality_options);
    compare("m of the stored contacts", g.quality.m, direct.m);
  }
  return broken;
}

/// Returns options by which the planner stops at the first `count` grasps.
inline PlannerOptions collecting(Acceptance acceptance, int count, int max_attempts) {
  PlannerOptions options;
  options.search = SearchRule::First;
  options.acceptance = acceptance;
  options.count = count;
  options.max_attempts = max_attempts;
  options.distinct = {0.0, 0.0, 0.0};
  return options;
}

}  // namespace graspfit::testing
