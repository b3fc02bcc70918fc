#include "internal/planner_attempts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "graspfit/grasp/wrench_convention.hpp"
#include "internal/object_size.hpp"
#include "internal/stopwatch.hpp"

namespace graspfit::grasp::internal {
namespace {

// Sides of a set that count as one draw: those of a triangle. Two targets have 16, so fewer such
// sets are drawn.
constexpr int kSidesPerDraw = 2;
// More than refinement may exceed its largest turn by [rad].
constexpr double kAngleSlack = 1e-6;

/// `options` with what the planner's rules set where they leave it open.
PlannerOptions with_planner_rules(const ObjectModel& object, const hands::HandModel& hand,
                                  PlannerOptions options) {
  options.validate();
  const RequestedParts parts = requested_parts(hand, options);
  if (options.targets.min_separation == 0.0) {
    options.targets.min_separation = fingertip_width(hand, parts.fingers);
  }
  options.quality.merge_distance = merge_distance(options, object.grid.lattice.voxel_size);
  // Refinement moves the palm too, and would undo what settling did.
  options.fitting.settle = options.fitting.settle && !options.refine;
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
  scene.wrench_object = wrench_object(object.mesh(), object.mass.center_of_mass);
  scene.friction = options.friction;
  scene.quality_context = {.center_of_mass_O = object.mass.center_of_mass,
                           .normalizing_radius = object.normalizing_radius,
                           .hand = &hand.model()};
  scene.quality_options = options.quality;
  scene.contact_options = {
      .clip_thickness = clip_thickness(options, object.grid.lattice.voxel_size),
      .averaging = options.averaging};
  if (options.refine) scene.largest_gap = options.refinement.largest_gap;
  return scene;
}

/// Why M is zero.
AttemptOutcome unusable_outcome(const Grasp& grasp) {
  const bool is_all_weak =
      !grasp.contacts.empty() &&
      std::all_of(grasp.contacts.begin(), grasp.contacts.end(),
                  [](const Contact& contact) { return contact.weak.value_or(false); });
  if (is_all_weak) return AttemptOutcome::Weak;
  return grasp.quality.stable_pairs.empty() ? AttemptOutcome::Unstable : AttemptOutcome::PoorShape;
}

/// An accepted grasp before any other, then the later stage.
bool is_better(const AttemptResult& a, const AttemptResult& b) {
  return std::make_tuple(a.is_accepted, stage_of(a.outcome)) >
         std::make_tuple(b.is_accepted, stage_of(b.outcome));
}

}  // namespace

int stage_of(AttemptOutcome outcome) {
  switch (outcome) {
    case AttemptOutcome::NoTargets:
      return 0;
    case AttemptOutcome::InitialCollision:
      return 1;
    case AttemptOutcome::IterationLimit:
      return 2;
    case AttemptOutcome::BlockedFinger:
    case AttemptOutcome::MissedContact:
      return 3;
    case AttemptOutcome::GapLeft:
      return 4;
    case AttemptOutcome::Weak:
    case AttemptOutcome::Unstable:
    case AttemptOutcome::PoorShape:
      return 5;
    case AttemptOutcome::SelfCollision:
      return 6;
    case AttemptOutcome::NoWayIn:
      return 7;
    case AttemptOutcome::UsableOnly:
      return 8;
    case AttemptOutcome::Valid:
      return 9;
  }
  return 0;
}

const char* failure_name(TargetFailure failure) {
  switch (failure) {
    case TargetFailure::NoSeed:
      return "no seed";
    case TargetFailure::NoSecond:
      return "no second";
    case TargetFailure::NoFurther:
      return "no further";
    case TargetFailure::NoPalm:
      return "no palm";
  }
  return "";
}

PlannerAttempts::PlannerAttempts(const ObjectModel& object, const hands::HandModel& hand,
                                 const PlannerOptions& options, const Surroundings& surroundings)
    : object_(object),
      hand_(hand),
      options_(with_planner_rules(object, hand, options)),
      parts_(requested_parts(hand, options)),
      fitting_hand_(hand, options_.fitting.sample_spacing * object.grid.lattice.voxel_size),
      distances_(part_distances(hand)),
      surroundings_(hand, surroundings),
      scene_(measuring_scene(object, fitting_hand_, surroundings_, options_)),
      claimed_pads_(requested_pads(hand, parts_)) {
  check_object_size(object.mesh(), hand, parts_.fingers, widest_opening(distances_, parts_));
  if (options_.targets.search == TargetSearch::Ranked) {
    ranked_.emplace(object, distances_, parts_, options_.targets);
  } else {
    selector_.emplace(object, distances_, parts_, options_.targets);
  }
}

AttemptResult PlannerAttempts::make(std::int64_t number) const {
  AttemptResult work;  // counters and times of everything that this attempt tries
  std::vector<Start> starts = draw_starts(number, work);
  if (starts.size() > static_cast<std::size_t>(options_.max_placements)) {
    starts.erase(starts.begin() + options_.max_placements, starts.end());
  }
  std::optional<AttemptResult> best;
  for (const Start& start : starts) {
    AttemptResult tried = try_start(start, number);
    work.fitting_iterations += tried.fitting_iterations;
    work.refinement_iterations += tried.refinement_iterations;
    work.timings += tried.timings;
    if (!best || is_better(tried, *best)) best = std::move(tried);
    if (best->is_accepted) break;
  }
  if (best) {
    work.outcome = best->outcome;
    work.grasp = std::move(best->grasp);
    work.is_accepted = best->is_accepted;
  }
  return work;
}

/// Target sets and their sides, the better side first; of several random sets the one whose targets
/// suit the fingertips best. Empty if there is none: the reason is in `result`.
std::vector<PlannerAttempts::Start> PlannerAttempts::draw_starts(std::int64_t number,
                                                                 AttemptResult& result) const {
  const Stopwatch watch(result.timings.targets_s);
  const auto by_misfit = [](const Start& a, const Start& b) { return a.misfit < b.misfit; };
  if (ranked_) {
    const std::optional<TargetContacts> targets = ranked_targets(number);
    if (!targets) {
      result.is_exhausted = true;
      if (number == 0) result.target_failure = ranked_->failure();
      return {};
    }
    std::vector<Start> starts = starts_of(*targets);
    if (starts.empty()) result.target_failure = TargetFailure::NoFurther;
    std::stable_sort(starts.begin(), starts.end(), by_misfit);
    return starts;
  }
  geometry::Random random =
      geometry::Random::stream(options_.seed, static_cast<std::uint64_t>(number));
  std::vector<Start> best;
  TargetFailure failure = TargetFailure::NoFurther;  // no side within the cone of approach
  double best_misfit = std::numeric_limits<double>::infinity();
  int num_judged = 0;
  // Where sets are rare, the seeds of one search are the budget of all draws together.
  const auto may_draw = [&](int draw) {
    return draw < num_draws() && num_judged < kSidesPerDraw * num_draws() &&
           (best.empty() || result.seeds_tried < options_.targets.max_seeds);
  };
  for (int draw = 0; may_draw(draw); ++draw) {
    const TargetSelection selection = selector_->select(random);
    result.seeds_tried += selection.seeds_tried;
    if (!selection.targets) {
      failure = selection.failure;
      break;  // the search gave up after many seeds of its own
    }
    std::vector<Start> starts = starts_of(*selection.targets);
    if (starts.empty()) continue;
    num_judged += static_cast<int>(starts.size());
    if (options_.target_draws == 1) return starts;
    const double misfit = std::min_element(starts.begin(), starts.end(), by_misfit)->misfit;
    if (misfit >= best_misfit) continue;
    best_misfit = misfit;
    std::stable_sort(starts.begin(), starts.end(), by_misfit);
    best = std::move(starts);
  }
  if (best.empty()) result.target_failure = failure;
  return best;
}

/// Sets with a target for the palm are chosen by the fingers' reach already.
int PlannerAttempts::num_draws() const {
  return parts_.palm ? std::max(1, options_.target_draws / 4) : options_.target_draws;
}

/// The sides from which to reach for a set, in the order of their placements.
std::vector<PlannerAttempts::Start> PlannerAttempts::starts_of(
    const TargetContacts& targets) const {
  std::vector<Start> starts;
  for (const PalmPlacement& placement :
       palm_placements(object_, targets, options_.approach_O, options_.approach_angle)) {
    Start start{assign_fingers(hand_, targets, parts_, placement), placement};
    if (options_.target_draws > 1 || ranked_) {
      start.misfit = reach_misfit(hand_, start.targets, placement);
    }
    starts.push_back(std::move(start));
  }
  return starts;
}

std::optional<TargetContacts> PlannerAttempts::ranked_targets(std::int64_t number) const {
  const std::lock_guard<std::mutex> lock(ranked_lock_);
  while (static_cast<std::int64_t>(ranked_sets_.size()) <= number) {
    std::optional<TargetContacts> next = ranked_->next();
    if (!next) return std::nullopt;
    ranked_sets_.push_back(std::move(*next));
  }
  return ranked_sets_[static_cast<std::size_t>(number)];
}

/// One hand fitted to one target set from one side.
AttemptResult PlannerAttempts::try_start(const Start& start, std::int64_t number) const {
  AttemptResult result;
  hands::HandConfiguration configuration;
  std::optional<AttemptOutcome> failure = fit(start, configuration, result);
  // Refinement also brings fingers home that stopped short of the surface.
  const bool is_refinable = options_.refine && failure != AttemptOutcome::InitialCollision;
  if (is_refinable) failure = refine(start.targets, configuration, result);
  if (failure) {
    result.outcome = *failure;
    return result;
  }
  Grasp grasp;
  {
    const Stopwatch watch(result.timings.measure_s);
    grasp = measure_grasp(scene_, configuration, parts_);
    grasp.targets = start.targets;
    grasp.ideal_m = ideal_m(start.targets);
    grasp.attempt = number;
    grasp.iterations = static_cast<int>(result.fitting_iterations);
    grasp.refinement_iterations = static_cast<int>(result.refinement_iterations);
  }
  if (!grasp.is_usable()) {
    result.outcome = unusable_outcome(grasp);
    return result;
  }
  if (!options_.refine && grasp.penetration.self_depth > options_.self_overlap) {
    result.outcome = AttemptOutcome::SelfCollision;
    return result;
  }
  complete(grasp, result);
  if (grasp.is_valid() && options_.pre_grasps && !grasp.pre_grasp) {
    result.outcome = AttemptOutcome::NoWayIn;
    return result;
  }
  // A start that cut something may have been turned before refinement.
  const bool is_as_asked = angle_from_approach(grasp.configuration) <= options_.approach_angle &&
                           are_scores_high(grasp.contacts);
  const bool is_valid = is_as_asked && grasp.is_valid();
  result.outcome = is_valid ? AttemptOutcome::Valid : AttemptOutcome::UsableOnly;
  result.is_accepted = is_as_asked && is_accepted(grasp);
  result.grasp = std::move(grasp);
  return result;
}

/// The paper's loop. Why it failed, if it did; the configuration it ended at in any case.
std::optional<AttemptOutcome> PlannerAttempts::fit(const Start& start,
                                                   hands::HandConfiguration& configuration,
                                                   AttemptResult& result) const {
  const Stopwatch watch(result.timings.fitting_s);
  const FittingResult fitted =
      fit_hand(fitting_hand_, object_, surroundings_, options_.style, start.targets,
               start.placement, scene_.contact_options, options_.fitting);
  result.fitting_iterations += fitted.iterations;
  result.timings.contact_tests_s += fitted.contact_tests_s;
  configuration = fitted.configuration;
  switch (fitted.stop) {
    case FittingStop::InitialCollision:
      return AttemptOutcome::InitialCollision;
    case FittingStop::BlockedFinger:
      return AttemptOutcome::BlockedFinger;
    case FittingStop::MissedContact:
      return AttemptOutcome::MissedContact;
    case FittingStop::IterationLimit:
      return AttemptOutcome::IterationLimit;
    case FittingStop::Contact:
      break;
  }
  return std::nullopt;
}

/// From voxels to true contact.
std::optional<AttemptOutcome> PlannerAttempts::refine(const TargetContacts& targets,
                                                      hands::HandConfiguration& configuration,
                                                      AttemptResult& result) const {
  const Stopwatch watch(result.timings.refinement_s);
  RefinementOptions refinement = options_.refinement;
  if (options_.approach_O) {
    const double left = options_.approach_angle - angle_from_approach(configuration) - kAngleSlack;
    refinement.largest_turn = std::min(refinement.largest_turn, std::max(0.0, left));
  }
  const RefinementResult refined =
      refine_contacts(fitting_hand_, object_, surroundings_, claimed_pads_, &targets, configuration,
                      scene_.contact_options, refinement);
  result.refinement_iterations += refined.iterations;
  configuration = refined.configuration;
  switch (refined.stop) {
    case RefinementStop::Contact:
      return std::nullopt;
    case RefinementStop::OutOfReach:
      return AttemptOutcome::MissedContact;
    case RefinementStop::Intersecting:
      return AttemptOutcome::BlockedFinger;
    case RefinementStop::SelfCollision:
      return AttemptOutcome::SelfCollision;
    case RefinementStop::GapLeft:
    case RefinementStop::IterationLimit:
      break;
  }
  return AttemptOutcome::GapLeft;
}

/// Adds the way in and the squeeze.
void PlannerAttempts::complete(Grasp& grasp, AttemptResult& result) const {
  const Stopwatch watch(result.timings.pre_grasp_s);
  if (options_.pre_grasps && !grasp.penetration.is_any()) {
    grasp.pre_grasp = find_pre_grasp(hand_, fitting_hand_.collision(), object_.query, surroundings_,
                                     grasp.configuration, options_.pre_grasp);
  }
  grasp.squeeze = squeeze_configuration(
      hand_, grasp.configuration, grasp.contacts, object_.mass.center_of_mass,
      scene_.wrench_object.largest_radius, options_.friction, options_.squeeze);
}

double PlannerAttempts::ideal_m(const TargetContacts& targets) const {
  std::vector<Contact> contacts;
  for (const TargetContact& target : targets.contacts) {
    Contact contact;
    contact.point_O = target.point_O;
    contact.inward_normal_O = -target.outward_normal_O;
    contact.finger = target.finger;
    contacts.push_back(contact);
  }
  return ideal_quality(contacts, scene_.quality_context, kIdealBoundaryDistance, kIdealArea,
                       options_.quality)
      .m;
}

/// Between the palm's direction and the one asked for [rad]; 0 if none is.
double PlannerAttempts::angle_from_approach(const hands::HandConfiguration& configuration) const {
  if (!options_.approach_O) return 0.0;
  const Eigen::Vector3d palm = configuration.X_OH.linear() * hand_.palm.direction_H;
  const Eigen::Vector3d& wanted = *options_.approach_O;
  return std::atan2(palm.cross(wanted).norm(), palm.dot(wanted));
}

/// Fingers miss their targets, so a target's score says little about the contact's.
bool PlannerAttempts::are_scores_high(const std::vector<Contact>& contacts) const {
  if (!options_.contact_score_threshold) return true;
  return std::all_of(contacts.begin(), contacts.end(), [&](const Contact& contact) {
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
    case Acceptance::Quality:
      return grasp.is_usable() && grasp.quality.m >= std::min(0.5 * grasp.ideal_m, 0.6);
  }
  return false;
}

}  // namespace graspfit::grasp::internal
