#include "planner/planner_readings.hpp"

#include <algorithm>
#include <array>

#include "graspfit/base/number_text.hpp"
#include "graspfit/grasp/grasp_guidance.hpp"
#include "graspfit/grasp/option_names.hpp"

namespace graspfit::grasp::internal {
namespace {

using base::shortest_decimal;

/// Whether a reading is about scores.
bool is_about_scores(std::string_view number) {
  constexpr std::array about = {"A1", "A2", "A3", "A4", "A5"};
  return std::find(about.begin(), about.end(), number) != about.end();
}

/// Whether a reading is about how targets are chosen by their scores.
bool is_about_choice(std::string_view number) {
  constexpr std::array about = {"A19", "A20", "A48"};
  return std::find(about.begin(), about.end(), number) != about.end();
}

/// Whether a reading is about targets, however chosen, or the posture at them.
bool is_about_targets(std::string_view number) {
  constexpr std::array about = {"A17", "A18", "A21", "A22", "A23", "A24", "A25", "A26", "A28"};
  return std::find(about.begin(), about.end(), number) != about.end();
}

/// Whether a reading is about what lies between chosen targets and a hand at the object. Targets by
/// the hand's reach come with a posture at the object, from which it is refined.
bool is_about_fitting(std::string_view number) {
  constexpr std::array about = {"A17", "A18", "A19", "A21", "A23",
                                "A24", "A26", "A28", "A29", "A30"};
  return std::find(about.begin(), about.end(), number) != about.end();
}

/// Which set of targets an attempt takes.
std::string choice_reading(const PlannerOptions& options) {
  const TargetOptions& targets = options.targets;
  std::string kept;
  if (compares_all_sets(options.kept)) {
    kept = ", of whose sides the " + std::string(name_of(options.kept)) + " grasp is kept";
  }
  if (targets.search == TargetSearch::Ranked) {
    return "every feasible set once, those that fit best first" + kept;
  }
  if (targets.search == TargetSearch::Reach) {
    return "where the pads of a hand that is laid onto the object lie, strongest first" + kept;
  }
  const bool is_balance_first =
      options.candidate_order == CandidateOrder::Balance && options.target_draws > 1;
  return "drawn from the best " + shortest_decimal(targets.pool_fraction) + ", at least " +
         std::to_string(targets.pool_minimum) + "; " + std::to_string(targets.max_seeds) +
         " seeds per set; the second of three or more from all; fitted: the flattest for the "
         "fingertip pads of " +
         std::to_string(options.target_draws) + " sets" +
         (is_balance_first ? ", those that balance first" : "") + kept;
}

std::string text(std::string_view name) { return std::string(name); }

std::string rejection_reading(const PlannerOptions& options) {
  switch (options.rejection) {
    case Rejection::None:
      break;
    case Rejection::Deviation:
      return "; rejected: a contact farther from its target than " +
             (options.largest_deviation ? shortest_decimal(*options.largest_deviation) + " m"
                                        : text("a fingertip pad is wide"));
    case Rejection::Quality:
      return "; rejected: M below half of the targets' own and below 0.6";
  }
  return "";
}

}  // namespace

std::vector<std::pair<std::string, std::string>> planner_readings(const PlannerOptions& options) {
  const ScoreOptions& score = options.score;
  const TargetOptions& targets = options.targets;
  const FittingOptions& fitting = options.fitting;
  const contact::QualityOptions& quality = options.quality;
  const std::string averaging = text(name_of(options.averaging));
  const std::string units = text(name_of(quality.units));

  // Of another library's method everything may matter.
  const PlanningMethod* const known = planning_methods().find(options.planner);
  const bool has_scores = known == nullptr || known->has_scores;
  const bool has_targets = known == nullptr || known->has_targets;
  const bool is_by_reach = has_targets && targets.search == TargetSearch::Reach && options.refine;

  std::vector<std::pair<std::string, std::string>> readings = {
      {"A1", text(name_of(score.normalization))},
      {"A2", text(name_of(score.plane_distance))},
      {"A3", "L = " + shortest_decimal(score.length_voxels) + " voxels"},
      {"A4", "all other partial voxels of the window, connected or not"},
      {"A5", "mean filter of radius " + std::to_string(score.mean_filter_radius) + " voxels, " +
                 std::to_string(score.mean_filter_passes) + " passes, self included"},
      {"A6", averaging},
      {"A7", "projected to the nearest point of the patch"},
      {"A8",
       "resolution along the object's own longest extent; 8 voxels of room, beyond them distances "
       "are bounds from below"},
      {"A9", units},
      {"A10", units},
      {"A11", units},
      {"A12", "unusable"},
      {"A13", text(name_of(quality.regularity))},
      {"A14", "regularity 1, centroid at the midpoint"},
      {"A15", text(name_of(quality.centroid))},
      {"A16", "the palm is a finger of its own; links of one finger do not pair"},
      {"A17", text(name_of(targets.pair_rule))},
      {"A18", "per pair of fingers, by sampling forward kinematics; some assignment must fit all"},
      {"A19", "edges within " + shortest_decimal(targets.edge_tolerance_rel) +
                  ", centroid within " + shortest_decimal(targets.centroid_limit_rel) +
                  " of the normalizing radius, ranked; relaxed by half after " +
                  std::to_string(targets.relax_after_seeds) + " seeds"},
      {"A20", choice_reading(options)},
      {"A21", "assignment of least angular error around the palm axis"},
      {"A22", "the thumb if requested, else the first finger"},
      {"A23",
       options.approach_O
           ? "sides of the targets within the cone of the approach direction"
           : "both normals of the targets, 16 directions for two, against the palm's own target"},
      {"A24",
       "behind the posture at the targets, clear by " + shortest_decimal(fitting.clearance) + " m"},
      {"A25", "joint limits that open; spread aligned with the targets"},
      {"A26", "least sum of squared angular errors of the fingers that share a joint"},
      {"A27", "coupled, with breakaway"},
      {"A28", "all joints of a finger, to the posture at the targets by least squares"},
      {"A29",
       fitting.palm_after_contact == PalmAfterContact::Frozen
           ? text("the palm stays once a finger touches")
           : text("the palm goes on while contacts come nearer to targets; fingers close again")},
      {"A30", "fastest point moves at most " + shortest_decimal(fitting.large_step_limit) +
                  " voxels from " + shortest_decimal(fitting.large_step_at) + ", else " +
                  shortest_decimal(fitting.small_step)},
      {"A31", options.missing_contact == MissingContact::Fails
                  ? text("a part without contact fails the attempt")
                  : text("the contacts that there are count")},
      {"A32",
       (is_by_reach ? text("laid onto the object at the level of patches, then refined")
        : options.refine
            ? text("closed until the first sliver of surface in the clip volume, then refined")
        : fitting.contact_state == ContactState::Closed
            ? text("closed until the next motion would enter")
            : text("closed until the first sliver of surface in the clip volume")) +
           "; guard on " + text(name_of(fitting.guard))},
      {"A33", options.clip_thickness
                  ? "clip volume " + shortest_decimal(*options.clip_thickness) + " m thick"
                  : "clip volume max(0.5 voxel, 1 mm) thick"},
      {"A34", averaging +
                  (options.contact_pieces == contact::ContactPieces::Joined
                       ? ", one contact per pad"
                       : ", pieces far apart are contacts of their own") +
                  (options.contact_faces == contact::ContactFaces::All
                       ? ""
                       : ", without what looks away from the pad")},
      {"A35", contact_estimation(options, 1.0).pads == contact::CountedPads::All
                  ? text("contacts of all links count")
                  : text("contacts of fingertips and palm count")},
      {"A36",
       std::string(name_of(options.search)) + " " + std::string(name_of(options.acceptance)) +
           " of at most " + std::to_string(options.max_attempts) + " attempts" +
           (options.max_iterations ? ", " + std::to_string(*options.max_iterations) + " iterations"
                                   : "") +
           rejection_reading(options)},
      {"A37", options.weak ? "slender features thinner than " +
                                 shortest_decimal(options.weak->weak_thickness) + " m"
                           : text("not looked for: nothing counts as weak")},
      {"A39", "palm first until it touches, then every finger joint by joint"},
      {"A40", options.refine ? text("none, decided on the meshes")
                             : "overlap of different fingers above " +
                                   shortest_decimal(options.self_overlap) + " m ends the attempt"},
      {"A41", "volume integral over the closed mesh"},
      {"A42", "outline of the pad"},
      {"A43", "Euclidean"},
      {"A44", "the hand gives way for the stopped one of fingers that share a joint"},
      {"A45", "table and obstacles are solid"},
      {"A46", "repaired or refused; see object.repair"},
      {"A47",
       targets.theta_max == quality.theta_max ? "one angle for targets and measure" : "two angles"},
      {"A48", targets.ideal_m_bias > 0.0
                  ? "complete sets drawn by (ideal M)^" + shortest_decimal(targets.ideal_m_bias)
                  : text("measure not used in target selection")},
  };
  for (auto& [number, reading] : readings) {
    const bool is_unused =
        (!has_scores && is_about_scores(number) && !options.contact_score_threshold) ||
        (!has_scores && is_about_choice(number)) || (!has_targets && is_about_targets(number));
    if (is_unused) reading = "not used by planner " + options.planner;
    if (is_by_reach && is_about_fitting(number)) reading = "not used by target-search reach";
    if (number == "A47" && !has_targets) {
      reading = "of the measure alone: planner " + options.planner + " has no targets";
    }
  }
  return readings;
}

}  // namespace graspfit::grasp::internal
