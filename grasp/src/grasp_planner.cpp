#include "graspfit/grasp/grasp_planner.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_workspace.hpp"
#include "internal/option_check.hpp"
#include "internal/stopwatch.hpp"
#include "internal/target_marks.hpp"

namespace graspfit::grasp {
namespace {

using Eigen::Vector3d;
using geometry::InvalidInput;
using geometry::shortest_decimal;
using Clock = std::chrono::steady_clock;

/// Shorter side of the box around a pad's outline [m].
double pad_width(const hands::ContactPad& pad) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : pad.outline) box.extend(corner);
  return box.sizes().minCoeff();
}

std::string extents_of(const geometry::TriangleMesh& mesh) {
  const Vector3d size = geometry::bounding_box(mesh).sizes();
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    text += (axis > 0 ? " x " : "") + shortest_decimal(std::round(size[axis] * 1e6) / 1e6);
  }
  return text + " m";
}

/// Width of the widest fingertip pad among `fingers` [m].
double fingertip_width(const hands::HandModel& hand, const std::vector<int>& fingers) {
  double width = 0.0;
  for (const int finger : fingers) {
    width = std::max(width, pad_width(hand.pads[hand.fingers[finger].tip_pad]));
  }
  return width;
}

/// Refuses objects that could not be held whatever their pose: smaller than one fingertip, or
/// thicker than the fingers open (`widest`).
void check_size(const geometry::TriangleMesh& mesh, const hands::HandModel& hand,
                const std::vector<int>& fingers, double widest) {
  const auto in_tenths_of_millimeters = [](double length) {
    return shortest_decimal(std::round(length * 1e4) / 1e4) + " m";
  };
  const std::string advice =
      "; if the file is not in meters, say its unit (--mesh-unit) or its size (--longest)";
  if (geometry::bounding_box(mesh).sizes().minCoeff() > widest) {
    throw InvalidInput("the object measures " + extents_of(mesh) + ", hand " + hand.name +
                       " spans at most " + in_tenths_of_millimeters(widest) + advice);
  }
  const double smallest = fingertip_width(hand, fingers);
  if (geometry::longest_extent(mesh) < smallest) {
    throw InvalidInput("the object measures " + extents_of(mesh) +
                       ", less than one fingertip of hand " + hand.name + " (" +
                       in_tenths_of_millimeters(smallest) + ")" + advice);
  }
}

/// Largest distance between two of the fingertips [m].
double widest_opening(const hands::TipDistances& distances, const std::vector<int>& fingers) {
  double widest = 0.0;
  for (const int a : fingers) {
    for (const int b : fingers) widest = std::max(widest, distances[a][b].largest);
  }
  return widest;
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

GraspPenetration measure_penetration(const hands::HandCollision& collision,
                                     const geometry::MeshQuery& object,
                                     const std::vector<geometry::RigidTransform>& X_OL) {
  const hands::HandCollision::Result with_object = collision.against_object(object, X_OL);
  const hands::HandCollision::Result with_self = collision.against_self(X_OL);
  GraspPenetration result;
  result.object_intersects = with_object.intersects;
  result.object_depth = with_object.depth;
  result.object_depth_bound = with_object.depth_bound;
  result.object_link = with_object.link_a;
  result.self_intersects = with_self.intersects;
  result.self_depth = with_self.depth;
  result.self_link_a = with_self.link_a;
  result.self_link_b = with_self.link_b;
  return result;
}

/// The run of one planner: what stays the same over all attempts.
class Run {
 public:
  Run(const ObjectModel& object, const hands::HandModel& hand, const PlannerOptions& options)
      : object_(object),
        hand_(hand),
        options_(with_planner_rules(object, hand, options)),
        parts_(requested_parts(hand, options)),
        fingers_(parts_.fingers),
        fitting_hand_(hand, options_.fitting.sample_spacing * object.grid.lattice.voxel_size),
        distances_(part_distances(hand)),
        surroundings_(hand, {}) {
    context_.center_of_mass_O = object.mass.center_of_mass;
    context_.normalizing_radius = object.normalizing_radius;
    context_.hand = &hand_;
    contact_options_.clip_thickness = clip_thickness(options, object.grid.lattice.voxel_size);
    contact_options_.averaging = options.averaging;
    check_size(object.mesh(), hand, fingers_, widest_opening(distances_.tip_to_tip, fingers_));
  }

  PlannerResult operator()(const PlannerProgress& progress) {
    const Clock::time_point start = Clock::now();
    for (int outcome = 0; outcome <= static_cast<int>(AttemptOutcome::PoorShape); ++outcome) {
      result_.statistics.outcomes[static_cast<AttemptOutcome>(outcome)] = 0;
    }
    for (const TargetFailure failure :
         {TargetFailure::NoSeed, TargetFailure::NoSecond, TargetFailure::NoFurther}) {
      result_.statistics.target_failures[failure_name(failure)] = 0;
    }
    result_.stop = PlannerStop::Attempts;
    for (std::int64_t number = 0; number < options_.max_attempts; ++number) {
      attempt(number);
      if (progress) {
        progress(number + 1, static_cast<std::int64_t>(result_.grasps.size()));
      }
      if (options_.search == SearchRule::First &&
          static_cast<int>(result_.grasps.size()) >= options_.count) {
        result_.stop = PlannerStop::Count;
        break;
      }
      const double elapsed = std::chrono::duration<double>(Clock::now() - start).count();
      if (options_.wall_clock_limit_s && elapsed > *options_.wall_clock_limit_s) {
        result_.stop = PlannerStop::WallClock;
        break;
      }
    }
    std::stable_sort(result_.grasps.begin(), result_.grasps.end(),
                     [](const Grasp& a, const Grasp& b) { return a.quality.m > b.quality.m; });
    if (static_cast<int>(result_.grasps.size()) > options_.count) {
      result_.grasps.resize(static_cast<std::size_t>(options_.count));
    }
    result_.timings.total_s = std::chrono::duration<double>(Clock::now() - start).count();
    return std::move(result_);
  }

 private:
  /// How far an attempt that ended so had come.
  static int stage(AttemptOutcome outcome) {
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
      case AttemptOutcome::Weak:
      case AttemptOutcome::Unstable:
      case AttemptOutcome::PoorShape:
        return 4;
      case AttemptOutcome::GapLeft:
      case AttemptOutcome::NoWayIn:
      case AttemptOutcome::SelfCollision:
        return 5;
      case AttemptOutcome::UsableOnly:
        return 6;
      case AttemptOutcome::Valid:
        return 7;
    }
    return 0;
  }

  /// How one fit ended.
  struct Candidate {
    AttemptOutcome outcome = AttemptOutcome::NoTargets;
    std::optional<Grasp> grasp;
  };

  static PlannerOptions with_planner_rules(const ObjectModel& object, const hands::HandModel& hand,
                                           PlannerOptions options) {
    options.validate();
    const std::vector<int> fingers = requested_parts(hand, options).fingers;
    if (options.targets.min_separation == 0.0) {
      options.targets.min_separation = fingertip_width(hand, fingers);
    }
    options.quality.merge_distance = merge_distance(options, object.grid.lattice.voxel_size);
    return options;
  }

  void attempt(std::int64_t number) {
    PlannerStatistics& statistics = result_.statistics;
    ++statistics.attempts;
    geometry::Random random =
        geometry::Random::stream(options_.seed, static_cast<std::uint64_t>(number));
    std::optional<Candidate> best;
    for (const Start& start : draw_starts(random)) {
      Candidate candidate = fit(start, number);
      if (!best || is_better(candidate, *best)) best = std::move(candidate);
      if (best->grasp && is_accepted(*best->grasp)) break;
    }
    ++statistics.outcomes[best ? best->outcome : AttemptOutcome::NoTargets];
    if (best && best->grasp && is_accepted(*best->grasp)) {
      result_.grasps.push_back(std::move(*best->grasp));
    }
  }

  /// An accepted grasp before any other, a grasp before a failure, a failure at a later stage
  /// before an earlier one.
  bool is_better(const Candidate& a, const Candidate& b) const {
    const auto rank = [this](const Candidate& candidate) {
      const bool is_taken = candidate.grasp && is_accepted(*candidate.grasp);
      return std::make_tuple(is_taken, stage(candidate.outcome));
    };
    return rank(a) > rank(b);
  }

  /// Assigned targets and the side from which to reach for them.
  struct Start {
    TargetContacts targets;
    PalmPlacement placement;
  };

  /// Draws target sets and returns the sides of the one whose targets suit the fingertips best, the
  /// better side first. Empty if no draw has any: the reason is counted.
  std::vector<Start> draw_starts(geometry::Random& random) {
    const Stopwatch watch(result_.timings.targets_s);
    std::vector<Start> best;
    TargetFailure failure = TargetFailure::NoFurther;  // no side within 90 degrees of the approach
    double best_tilt = std::numeric_limits<double>::infinity();
    for (int draw = 0; draw < options_.target_draws; ++draw) {
      const TargetSelection selection =
          select_target_contacts(object_, distances_, parts_, options_.targets, random);
      result_.statistics.seeds_tried += selection.seeds_tried;
      if (!selection.targets) {
        failure = selection.failure;
        break;  // the search gave up after many seeds of its own
      }
      std::vector<Start> sides;
      std::vector<double> tilts;
      for (const PalmPlacement& placement :
           palm_placements(object_, *selection.targets, options_.approach_O,
                           options_.approach_angle)) {
        sides.push_back({assign_fingers(hand_, *selection.targets, parts_, placement), placement});
        tilts.push_back(pad_tilt(hand_, sides.back().targets, placement));
      }
      if (sides.empty()) continue;
      if (options_.target_draws == 1) return sides;
      const auto least = std::min_element(tilts.begin(), tilts.end());
      if (*least >= best_tilt) continue;
      best_tilt = *least;
      std::rotate(sides.begin(), sides.begin() + (least - tilts.begin()),
                  sides.begin() + (least - tilts.begin()) + 1);
      best = std::move(sides);
    }
    if (best.empty()) ++result_.statistics.target_failures[failure_name(failure)];
    return best;
  }

  /// One hand fitted to one target set from one side.
  Candidate fit(const Start& start, std::int64_t number) {
    FittingResult fitted;
    {
      const Stopwatch watch(result_.timings.fitting_s);
      fitted = fit_hand(fitting_hand_, object_, surroundings_, options_.style, start.targets,
                        start.placement, contact_options_, options_.fitting);
    }
    result_.statistics.fitting_iterations += fitted.iterations;
    result_.timings.contact_tests_s += fitted.contact_tests_s;
    switch (fitted.stop) {
      case FittingStop::InitialCollision:
        return {AttemptOutcome::InitialCollision, std::nullopt};
      case FittingStop::BlockedFinger:
        return {AttemptOutcome::BlockedFinger, std::nullopt};
      case FittingStop::MissedContact:
        return {AttemptOutcome::MissedContact, std::nullopt};
      case FittingStop::IterationLimit:
        return {AttemptOutcome::IterationLimit, std::nullopt};
      case FittingStop::Contact:
        break;
    }
    Grasp grasp;
    grasp.configuration = fitted.configuration;
    grasp.targets = start.targets;
    grasp.contacts = fitted.contacts;
    grasp.has_all_contacts = true;
    grasp.attempt = number;
    grasp.iterations = fitted.iterations;
    {
      const Stopwatch watch(result_.timings.measure_s);
      grasp.quality = contact_quality(grasp.contacts, context_, options_.quality);
      grasp.ideal_m = ideal_m(start.targets);
    }
    if (!grasp.is_usable()) {
      const bool is_unstable = grasp.quality.stable_pairs.empty();
      return {is_unstable ? AttemptOutcome::Unstable : AttemptOutcome::PoorShape, std::nullopt};
    }
    {
      const Stopwatch watch(result_.timings.measure_s);
      grasp.penetration =
          measure_penetration(fitting_hand_.collision(), object_.query,
                              hands::forward_kinematics(hand_, grasp.configuration));
    }
    if (grasp.penetration.self_depth > options_.self_overlap) {
      return {AttemptOutcome::SelfCollision, std::nullopt};
    }
    const AttemptOutcome outcome =
        grasp.is_valid() ? AttemptOutcome::Valid : AttemptOutcome::UsableOnly;
    return {outcome, std::move(grasp)};
  }

  double ideal_m(const TargetContacts& targets) const {
    std::vector<Contact> contacts;
    for (const TargetContact& target : targets.contacts) {
      Contact contact;
      contact.point_O = target.point_O;
      contact.inward_normal_O = -target.outward_normal_O;
      contact.finger = target.finger;
      contacts.push_back(contact);
    }
    return ideal_quality(contacts, context_, kIdealBoundaryDistance, kIdealArea, options_.quality)
        .m;
  }

  bool is_accepted(const Grasp& grasp) const {
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

  const ObjectModel& object_;
  const hands::HandModel& hand_;
  const PlannerOptions options_;
  const RequestedParts parts_;
  const std::vector<int> fingers_;
  const FittingHand fitting_hand_;
  const PartDistances distances_;
  const SurroundingsCollision surroundings_;
  QualityContext context_;
  ContactEstimationOptions contact_options_;
  PlannerResult result_;
};

}  // namespace

void PlannerOptions::validate() const {
  const auto require = [](bool is_met, std::string_view field, const auto& value,
                          std::string_view rule) {
    internal::require(is_met, "PlannerOptions", field, value, rule);
  };
  require(count >= 1, "count", count, ">= 1");
  require(max_attempts >= 1, "max_attempts", max_attempts, ">= 1");
  require(!fingers.empty() || num_contacts >= 2, "num_contacts", num_contacts, ">= 2");
  require(fingers.empty() || fingers.size() >= 2, "fingers", fingers.size(), "at least two names");
  require(resolution >= 4 && resolution <= 512, "resolution", resolution, "in [4, 512]");
  if (approach_O) {
    require(approach_O->allFinite() && approach_O->norm() > 0.0, "approach_O",
            shortest_decimal((*approach_O)[0]) + "," + shortest_decimal((*approach_O)[1]) + "," +
                shortest_decimal((*approach_O)[2]),
            "finite and not zero");
  }
  if (wall_clock_limit_s) {
    require(*wall_clock_limit_s > 0.0, "wall_clock_limit_s", *wall_clock_limit_s, "> 0 s");
  }
  if (clip_thickness) {
    require(*clip_thickness > 0.0 && std::isfinite(*clip_thickness), "clip_thickness",
            *clip_thickness, "finite and > 0 m");
  }
  require(target_draws >= 1, "target_draws", target_draws, ">= 1");
  require(self_overlap >= 0.0 && std::isfinite(self_overlap), "self_overlap", self_overlap,
          "finite and >= 0 m");
  score.validate();
  targets.validate();
  fitting.validate();
  quality.validate();
}

const char* outcome_name(AttemptOutcome outcome) {
  switch (outcome) {
    case AttemptOutcome::Valid:
      return "valid";
    case AttemptOutcome::UsableOnly:
      return "usable but not valid";
    case AttemptOutcome::NoTargets:
      return "no target set";
    case AttemptOutcome::InitialCollision:
      return "initial collision";
    case AttemptOutcome::BlockedFinger:
      return "blocked finger";
    case AttemptOutcome::MissedContact:
      return "missed contact";
    case AttemptOutcome::GapLeft:
      return "gap left";
    case AttemptOutcome::NoWayIn:
      return "no way in";
    case AttemptOutcome::Weak:
      return "weak features only";
    case AttemptOutcome::SelfCollision:
      return "self-collision";
    case AttemptOutcome::IterationLimit:
      return "iteration limit";
    case AttemptOutcome::Unstable:
      return "no stable pair";
    case AttemptOutcome::PoorShape:
      return "poor shape";
  }
  return "";
}

std::int64_t PlannerStatistics::usable() const {
  return valid() + outcomes.at(AttemptOutcome::UsableOnly);
}

std::int64_t PlannerStatistics::valid() const { return outcomes.at(AttemptOutcome::Valid); }

double clip_thickness(const PlannerOptions& options, double voxel_size) {
  return options.clip_thickness.value_or(std::max(0.5 * voxel_size, 0.001));
}

double merge_distance(const PlannerOptions& options, double voxel_size) {
  return options.quality.merge_distance > 0.0 ? options.quality.merge_distance : 0.1 * voxel_size;
}

RequestedParts requested_parts(const hands::HandModel& hand, const PlannerOptions& options) {
  RequestedParts parts;
  parts.palm = options.palm.value_or(options.style == GraspStyle::Power);
  std::vector<int>& fingers = parts.fingers;
  if (options.fingers.empty()) {
    if (options.num_contacts > static_cast<int>(hand.fingers.size())) {
      throw InvalidInput("hand " + hand.name + " has " + std::to_string(hand.fingers.size()) +
                         " fingers, " + std::to_string(options.num_contacts) +
                         " contacts were asked for");
    }
    fingers.push_back(hand.thumb());
    for (int finger = 0; static_cast<int>(fingers.size()) < options.num_contacts; ++finger) {
      if (finger != hand.thumb()) fingers.push_back(finger);
    }
  } else {
    for (const std::string& name : options.fingers) {
      const int finger = hand.finger_index(name);
      if (std::find(fingers.begin(), fingers.end(), finger) != fingers.end()) {
        throw InvalidInput("finger " + name + " is named twice");
      }
      fingers.push_back(finger);
    }
  }
  for (const int finger : fingers) {
    if (hand.fingers[finger].tip_pad < 0) {
      throw InvalidInput("finger " + hand.fingers[finger].name + " of hand " + hand.name +
                         " has no fingertip pad");
    }
  }
  const auto thumb = std::find(fingers.begin(), fingers.end(), hand.thumb());
  if (thumb != fingers.end()) std::rotate(fingers.begin(), thumb, thumb + 1);
  return parts;
}

ObjectModel prepare_object(const geometry::TriangleMesh& mesh, const hands::HandModel& hand,
                           const PlannerOptions& options, ObjectModelTimings* timings) {
  options.validate();
  check_size(mesh, hand, requested_parts(hand, options).fingers, 2.0 * hands::largest_reach(hand));
  ObjectModelOptions object_options;
  object_options.resolution = options.resolution;
  object_options.averaging = options.averaging;
  object_options.score = options.score;
  return build_object_model(mesh, object_options, timings);
}

PlannerResult plan_grasps(const ObjectModel& object, const hands::HandModel& hand,
                          const PlannerOptions& options, const Surroundings& surroundings,
                          int num_threads, const PlannerProgress& progress) {
  (void)surroundings;
  (void)num_threads;
  return Run(object, hand, options)(progress);
}

Grasp measure_grasp(const MeasuringScene& scene, const hands::HandConfiguration& configuration,
                    const RequestedParts& requested) {
  const hands::HandModel& hand = scene.hand;
  hands::validate(hand, configuration);
  const std::vector<geometry::RigidTransform> X_OL = hands::forward_kinematics(hand, configuration);
  Grasp grasp;
  grasp.configuration = configuration;
  grasp.contacts = estimate_contacts(hand, X_OL, scene.object, scene.contact_options);
  grasp.has_all_contacts = true;
  for (const int finger : requested.fingers) {
    const bool has_contact = internal::mark_targets(grasp.contacts, hand.fingers[finger].tip_pad);
    grasp.has_all_contacts = grasp.has_all_contacts && has_contact;
  }
  grasp.quality = contact_quality(grasp.contacts, scene.quality_context, scene.quality_options);
  grasp.penetration = measure_penetration(scene.collision, scene.object, X_OL);
  return grasp;
}

}  // namespace graspfit::grasp
