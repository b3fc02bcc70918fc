#include "planner/planner_attempts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "approach/way_up.hpp"
#include "fitting/idle_fingers.hpp"
#include "grasp/grasp_measure.hpp"
#include "graspfit/base/stopwatch.hpp"
#include "graspfit/contact/wrench_convention.hpp"
#include "graspfit/grasp/grasp_measure.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/hands/palm_pose.hpp"
#include "methods/firmness.hpp"
#include "planner/attempt_outcomes.hpp"
#include "targets/object_size.hpp"

namespace graspfit::grasp::internal {
namespace {

// With `Rejection::Quality` an attempt is given up where M is below both limits: higher limits keep
// better grasps at the cost of more attempts, as M itself selects.
constexpr double kHighQuality = 0.6;  // of M
constexpr double kIdealShare = 0.5;   // of the targets' own M
// An angle larger than the one by which refinement may exceed its largest turn [rad].
constexpr double kAngleSlack = 1e-6;
// Targets are drawn anew for less. A table in docs/performance.md says what it takes and gains to
// ask for less or more, and to search longer by another share of a first draw for every draw
// before.
constexpr double kFirm = 0.04;  // over a table less by every draw, as seldom is it reached there
constexpr double kMoreEffort = 1.5;

/// That of no grasp, as of one that no contact bears.
constexpr double kNoStrength = -std::numeric_limits<double>::infinity();
/// What a start may become that promises nothing.
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// `options`, completed by the planner's rules where they leave a value open.
PlannerOptions with_planner_rules(const ObjectModel& object, const hands::HandModel& hand,
                                  PlannerOptions options) {
  options.validate();
  const RequestedParts parts = requested_parts(hand, options);
  if (!options.targets.min_separation) {
    options.targets.min_separation = fingertip_width(hand, parts.fingers);
  }
  options.quality.merge_distance = merge_distance(options, object.grid.lattice.voxel_size);
  options.fitting = fitting_options(options);
  return options;
}

MeasuringScene measuring_scene(const ObjectModel& object, const FittingHand& hand,
                               const SurroundingsCollision& surroundings,
                               const PlannerOptions& options) {
  MeasuringScene scene{.hand = hand.model(),
                       .collision = hand.collision(),
                       .object = object.query,
                       .surroundings = surroundings};
  scene.weak = object.weak ? &*object.weak : nullptr;
  scene.wrench_object = contact::wrench_object(object.mesh(), object.mass.center_of_mass);
  scene.friction = options.friction;
  scene.quality_context = {.center_of_mass_O = object.mass.center_of_mass,
                           .normalizing_radius = object.normalizing_radius,
                           .hand = &hand.model()};
  scene.quality_options = options.quality;
  scene.contact_options =
      contact_estimation(options, clip_thickness(options, object.grid.lattice.voxel_size));
  scene.largest_gap = scene.bearing_gap = bearing_gap(options);
  return scene;
}

/// The fingers that touch with their tips' pads.
std::vector<int> fingers_with_tips(const hands::HandModel& hand, const RequestedParts& parts) {
  std::vector<int> fingers = parts.fingers;
  std::erase_if(fingers, [&](int finger) {
    return std::any_of(parts.other_pads.begin(), parts.other_pads.end(),
                       [&](int pad) { return hand.pads[pad].finger == finger; });
  });
  return fingers;
}

/// Residual of the grasp's squeeze; infinite without one.
double squeeze_residual(const AttemptResult& result) {
  return result.grasp && result.grasp->squeeze ? result.grasp->squeeze->residual
                                               : std::numeric_limits<double>::infinity();
}

bool is_balanced(const AttemptResult& result) {
  return result.grasp && result.grasp->squeeze && result.grasp->squeeze->is_balanced;
}

}  // namespace

PlannerAttempts::PlannerAttempts(const ObjectModel& object, const hands::HandModel& hand,
                                 const PlannerOptions& options, const Surroundings& surroundings,
                                 const PlanningMethods& methods)
    : object_(object),
      hand_(hand),
      options_(with_planner_rules(object, hand, options)),
      parts_(requested_parts(hand, options)),
      fitting_hand_(hand, options_.fitting.sample_spacing * object.grid.lattice.voxel_size),
      surroundings_(hand, surroundings),
      scene_(measuring_scene(object, fitting_hand_, surroundings_, options_)),
      largest_deviation_(largest_deviation(options_, hand)) {
  const PlanningMethod& method = methods.at(options_.planner);
  const base::Stopwatch watch(guidance_s_);
  guidance_ = method.make(
      {{fitting_hand_, object_, surroundings_, scene_.contact_options}, parts_, options_});
}

double PlannerAttempts::strength(const Grasp& grasp) const {
  return grasp_strength(grasp, scene_.wrench_object, options_.squeeze_friction, scene_.bearing_gap);
}

double PlannerAttempts::firmness_of(const Grasp& grasp) const {
  const std::vector<contact::Contact> touching =
      contact::touching_contacts(grasp.contacts, scene_.bearing_gap);
  return touching.empty() ? kNoStrength
                          : firmness(touching, scene_.wrench_object, firmness_friction(options_));
}

AttemptResult PlannerAttempts::make(std::int64_t number, const TriedStartObserver& observer) const {
  AttemptResult work;  // counters and times of everything that this attempt tries
  const auto timed = [&](const auto& draw) {
    const base::Stopwatch watch(work.timings.targets_s);
    return draw();
  };
  GuidedStarts guided = timed([&] { return guidance_->starts(number); });
  work.target_failure = guided.failure;
  work.is_exhausted = guided.is_exhausted;
  work.seeds_tried = guided.seeds_tried;
  std::vector<AttemptResult> tried;
  std::size_t best = try_starts(guided.starts, number, observer, tried);
  for (int redraws = 1; redraws <= options_.max_redraws && guided.redraw; ++redraws) {
    if (!tried.empty() && may_be_kept(tried[best], redraws)) break;
    // Where nothing closes, it takes more work to find what does; where something does, more draws.
    const bool closes = !tried.empty() && tried[best].is_accepted && tried[best].firmness > 0.0;
    const double effort = closes ? 1.0 : 1.0 + kMoreEffort * redraws;
    guided = timed([&] { return guided.redraw(effort); });
    work.seeds_tried += guided.seeds_tried;
    best = try_starts(guided.starts, number, observer, tried);
  }
  for (const AttemptResult& result : tried) {
    work.fitting_iterations += result.fitting_iterations;
    work.refinement_iterations += result.refinement_iterations;
    work.timings += result.timings;
  }
  if (!tried.empty()) {
    work.target_failure.reset();
    work.outcome = tried[best].outcome;
    work.grasp = std::move(tried[best].grasp);
    work.is_accepted = tried[best].is_accepted;
  }
  return work;
}

/// Tries starts until one is enough, adds the results to those of earlier draws, and returns the
/// index of the best of all, its pre-grasp known.
std::size_t PlannerAttempts::try_starts(const std::vector<GuidedStart>& starts, std::int64_t number,
                                        const TriedStartObserver& observer,
                                        std::vector<AttemptResult>& tried) const {
  for (std::size_t i = 0; i < starts.size(); ++i) {
    tried.push_back(try_start(starts[i], number));
    if (observer) {
      const AttemptResult& last = tried.back();
      std::optional<Grasp> grasp = last.grasp;
      if (grasp) grasp = with_wrench_quality(scene_, std::move(*grasp));
      observer({number, starts[i], last.outcome, grasp ? &*grasp : nullptr});
    }
    const double promise =
        i + 1 < starts.size() ? starts[i + 1].promised_firmness.value_or(kUnlimited) : kUnlimited;
    if (is_enough(tried[best_of(tried)], promise) &&
        is_enough(tried[best_with_way_in(tried)], promise)) {
      break;
    }
  }
  return tried.empty() ? 0 : best_with_way_in(tried);
}

/// Index of the first result of the highest rank; a pre-grasp that was not searched for yet is
/// assumed to exist.
std::size_t PlannerAttempts::best_of(const std::vector<AttemptResult>& tried) const {
  std::size_t best = 0;
  StartRank best_rank = rank_of(tried[0]);
  for (std::size_t i = 1; i < tried.size(); ++i) {
    const StartRank rank = rank_of(tried[i]);
    if (!(rank > best_rank)) continue;
    best_rank = rank;
    best = i;
  }
  return best;
}

/// The same with pre-grasps known. A pre-grasp is searched for only for the current best result,
/// until the best one has been searched: no result ranks higher after its search.
std::size_t PlannerAttempts::best_with_way_in(std::vector<AttemptResult>& tried) const {
  for (;;) {
    const std::size_t best = best_of(tried);
    if (!tried[best].is_way_in_open_question) return best;
    tried[best] = with_way_in(std::move(tried[best]));
  }
}

/// Rank of a result: an accepted grasp before any other, then the later stage, then what
/// `PlannerOptions::kept` compares.
PlannerAttempts::StartRank PlannerAttempts::rank_of(const AttemptResult& result) const {
  StartRank rank{result.is_accepted, stage_of(result.outcome), false, 0.0};
  switch (options_.kept) {
    case KeptCandidate::First:
      break;
    case KeptCandidate::Balanced:
      std::get<3>(rank) = -squeeze_residual(result);
      break;
    case KeptCandidate::Strongest:
      std::get<2>(rank) = is_balanced(result);
      std::get<3>(rank) = result.grasp ? strength(*result.grasp) : kNoStrength;
      break;
    case KeptCandidate::Firmest:
      std::get<3>(rank) = result.firmness;
      break;
  }
  return rank;
}

/// Whether no further start of a draw need be tried, of which the next one promises so much.
bool PlannerAttempts::is_enough(const AttemptResult& result, double promise) const {
  if (!result.is_accepted) return false;
  switch (options_.kept) {
    case KeptCandidate::First:
      return true;
    case KeptCandidate::Balanced:
      return is_balanced(result);
    case KeptCandidate::Firmest:
      return result.firmness >= promise;
    case KeptCandidate::Strongest:
      break;
  }
  return false;
}

/// Whether the best result of all of so many draws is good enough for targets not to be drawn anew.
bool PlannerAttempts::may_be_kept(const AttemptResult& result, int num_draws) const {
  if (!result.is_accepted) return false;
  switch (options_.kept) {
    case KeptCandidate::First:
      break;
    case KeptCandidate::Balanced:
    case KeptCandidate::Strongest:
      return is_balanced(result);
    case KeptCandidate::Firmest:
      return result.firmness >=
             (surroundings_.surroundings().table_z_O ? kFirm / (num_draws * num_draws) : kFirm);
  }
  return true;
}

/// One hand closed from one start.
AttemptResult PlannerAttempts::try_start(const GuidedStart& start, std::int64_t number) const {
  AttemptResult result;
  Reached reached = close(start, result);
  // Refinement also brings fingers into contact that stopped short of the surface.
  const bool is_refinable = options_.refine && reached.failure != AttemptOutcome::InitialCollision;
  const RequestedParts parts = parts_to_touch(options_, parts_, start.targets);
  if (is_refinable) {
    const bool is_drawn = start.draws_to_targets && !start.targets.contacts.empty();
    reached = refine(reached.configuration, requested_pads(hand_, parts),
                     is_drawn ? &start.targets : nullptr, result);
    if (!reached.failure && options_.idle_fingers == IdleFingers::Close) {
      const base::Stopwatch watch(result.timings.refinement_s);
      reached.configuration = with_idle_fingers_closed(
          {fitting_hand_, object_, surroundings_, scene_.contact_options}, reached.configuration,
          fingers_with_tips(hand_, parts), options_.fitting);
    }
  }
  const std::optional<AttemptOutcome>& failure = reached.failure;
  const bool is_measured =
      !failure ||
      (options_.missing_contact == MissingContact::Measured &&
       (*failure == AttemptOutcome::BlockedFinger || *failure == AttemptOutcome::MissedContact));
  if (!is_measured) {
    result.outcome = *failure;
    return result;
  }
  PosedGrasp measured;
  Grasp& grasp = measured.grasp;
  {
    const base::Stopwatch watch(result.timings.measure_s);
    measured = with_contacts(scene_, reached.configuration, parts);
    grasp.targets = start.targets;
    if (!start.targets.contacts.empty()) {
      grasp.ideal_m = ideal_m(object_, start.targets, {&hand_, options_.quality});
    }
    grasp.attempt = number;
    grasp.iterations = static_cast<int>(result.fitting_iterations);
    grasp.refinement_iterations = static_cast<int>(result.refinement_iterations);
  }
  if (!grasp.is_usable()) {
    result.outcome = failure.value_or(unusable_outcome(grasp));
    return result;
  }
  {
    const base::Stopwatch watch(result.timings.measure_s);
    measured = with_self_penetration(scene_, std::move(measured));
  }
  if (!options_.refine && grasp.penetration.self_depth > options_.self_overlap) {
    result.outcome = AttemptOutcome::SelfCollision;
    return result;
  }
  if (is_rejected(grasp)) {
    result.outcome = AttemptOutcome::Rejected;
    return result;
  }
  {
    const base::Stopwatch watch(result.timings.measure_s);
    measured = with_penetration(scene_, std::move(measured));
  }
  // A start that cut something may have been turned before refinement.
  const bool is_as_asked = angle_from_approach(grasp.configuration) <= options_.approach_angle &&
                           are_scores_high(grasp.contacts);
  const bool is_valid = is_as_asked && grasp.is_valid();
  result.outcome = is_valid ? AttemptOutcome::Valid : AttemptOutcome::UsableOnly;
  result.is_accepted = is_as_asked && is_accepted(grasp);
  result.is_way_in_open_question = true;
  result.grasp = std::move(grasp);
  result.X_OL = std::move(measured.X_OL);
  if (options_.kept == KeptCandidate::Firmest) {
    const base::Stopwatch watch(result.timings.measure_s);
    result.firmness = firmness_of(*result.grasp);
  } else if (options_.kept != KeptCandidate::First) {
    const base::Stopwatch watch(result.timings.pre_grasp_s);
    result.grasp->squeeze = squeeze_of(result);
  }
  return result;
}

/// Closes the hand from the start onto the object, at the level of voxels. Iterations and times are
/// added to those of `work`.
PlannerAttempts::Reached PlannerAttempts::close(const GuidedStart& start,
                                                AttemptResult& work) const {
  const base::Stopwatch watch(work.timings.fitting_s);
  const FittingResult fitted = start.close();
  work.fitting_iterations += fitted.iterations;
  work.timings.contact_tests_s += fitted.contact_tests_s;
  return {fitted.configuration, failure_of(fitted.stop)};
}

/// Brings a hand that is closed at the level of voxels into true contact. Iterations and times are
/// added to those of `work`.
PlannerAttempts::Reached PlannerAttempts::refine(const hands::HandConfiguration& closed,
                                                 const std::vector<int>& pads,
                                                 const TargetContacts* targets,
                                                 AttemptResult& work) const {
  const base::Stopwatch watch(work.timings.refinement_s);
  RefinementOptions refinement = options_.refinement;
  if (options_.approach_O) {
    const double left = options_.approach_angle - angle_from_approach(closed) - kAngleSlack;
    refinement.largest_turn = std::min(refinement.largest_turn, std::max(0.0, left));
  }
  const RefinementResult refined =
      refine_contacts({fitting_hand_, object_, surroundings_, scene_.contact_options}, pads,
                      targets, closed, refinement);
  work.refinement_iterations += refined.iterations;
  return {refined.configuration, failure_of(refined.stop)};
}

contact::Squeeze PlannerAttempts::squeeze_of(const AttemptResult& result) const {
  const Grasp& grasp = *result.grasp;
  const hands::PosedConfiguration posed{grasp.configuration, result.X_OL};
  return contact::squeeze_configuration(hand_, posed, grasp.contacts,
                                        {.center_of_mass_O = object_.mass.center_of_mass,
                                         .torque_scale = scene_.wrench_object.largest_radius,
                                         .friction = options_.squeeze_friction,
                                         .bearing_gap = scene_.bearing_gap},
                                        options_.squeeze);
}

/// Completes a grasp by its pre-grasp, without which it fails where one is required, by ε and, if
/// it is accepted, by its squeeze.
AttemptResult PlannerAttempts::with_way_in(AttemptResult result) const {
  result.is_way_in_open_question = false;
  Grasp& grasp = *result.grasp;
  if (options_.pre_grasps && !grasp.penetration.is_any()) {
    const base::Stopwatch watch(result.timings.pre_grasp_s);
    PreGraspOptions pre_grasp = options_.pre_grasp;
    // Targets by reach are met by whatever the joints can do.
    if (options_.targets.search == TargetSearch::Reach) {
      pre_grasp.open_neutral = true;
      pre_grasp.leave_pressing = true;
    }
    const PreGraspScene around{hand_, fitting_hand_.collision(), object_.query, surroundings_};
    const hands::PosedConfiguration posed{grasp.configuration, result.X_OL};
    grasp.pre_grasp = find_pre_grasp(around, posed, pre_grasp);
    // What is picked up from a table goes up.
    if (surroundings_.surroundings().table_z_O && !is_way_up_free(around, posed)) {
      grasp.pre_grasp.reset();
    }
  }
  if (grasp.is_valid() && options_.pre_grasps && !grasp.pre_grasp) {
    result.outcome = AttemptOutcome::NoWayIn;
    result.is_accepted = false;
    result.grasp.reset();
    return result;
  }
  {
    const base::Stopwatch watch(result.timings.measure_s);
    grasp = with_wrench_quality(scene_, std::move(grasp));
  }
  if (result.is_accepted && !grasp.squeeze) {
    const base::Stopwatch watch(result.timings.pre_grasp_s);
    grasp.squeeze = squeeze_of(result);
  }
  return result;
}

/// Angle between the palm's direction and the one asked for [rad]; 0 if none is asked for.
double PlannerAttempts::angle_from_approach(const hands::HandConfiguration& configuration) const {
  return hands::angle_from_approach(configuration.X_OH.linear() * hand_.palm.direction_H,
                                    options_.approach_O);
}

/// Whether the scores at the contacts are high enough. Fingers miss their targets, so the scores of
/// targets say little about those of contacts.
bool PlannerAttempts::are_scores_high(const std::vector<contact::Contact>& contacts) const {
  if (!options_.contact_score_threshold) return true;
  return std::all_of(contacts.begin(), contacts.end(), [&](const contact::Contact& contact) {
    return contact_score_at(object_, contact.point_O).value_or(0.0) >
           *options_.contact_score_threshold;
  });
}

bool PlannerAttempts::is_accepted(const Grasp& grasp) const {
  switch (options_.acceptance) {
    case Acceptance::Valid:
      return grasp.is_valid();
    case Acceptance::Usable:
      return grasp.is_usable();
  }
  return false;
}

bool PlannerAttempts::is_rejected(const Grasp& grasp) const {
  const bool has_targets = !grasp.targets.contacts.empty();
  switch (options_.rejection) {
    case Rejection::None:
      return false;
    case Rejection::Deviation: {
      const std::vector<double> distances = target_distances(grasp);
      return std::any_of(distances.begin(), distances.end(),
                         [&](double distance) { return distance > largest_deviation_; });
    }
    case Rejection::Quality:
      return grasp.quality.m <
             (has_targets ? std::min(kIdealShare * grasp.ideal_m, kHighQuality) : kHighQuality);
  }
  return false;
}

}  // namespace graspfit::grasp::internal
