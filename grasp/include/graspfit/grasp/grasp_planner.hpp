#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/grasp/contact_estimation.hpp"
#include "graspfit/grasp/contact_quality.hpp"
#include "graspfit/grasp/grasp.hpp"
#include "graspfit/grasp/hand_fitting.hpp"
#include "graspfit/grasp/object_model.hpp"
#include "graspfit/grasp/target_contacts.hpp"

namespace graspfit::grasp {

/// Grasp style (paper section 12).
enum class GraspStyle {
  Precision,  ///< Targets go to the fingertips.
};

/// Which grasps the planner collects.
enum class Acceptance {
  Valid,    ///< Usable, free of penetration on the true meshes, every requested contact there.
  Usable,   ///< M > 0: the paper's meaning.
  Quality,  ///< Usable and M ≥ min(0.5 · ideal M, 0.6): the paper's "high quality" (A36).
};

/// When the planner stops looking (notes A36).
enum class SearchRule {
  Best,   ///< Use all attempts and return the best accepted grasps: the paper's generate, evaluate,
          ///< select.
  First,  ///< Stop at the first accepted grasps: unselected sets, as for averages over usable
          ///< grasps.
};

/// Everything that decides what the planner does. Same options, object, hand and seed: same grasps.
struct PlannerOptions {
  GraspStyle style = GraspStyle::Precision;
  std::vector<std::string>
      fingers;  ///< Names from the hand, thumb anywhere; empty: `num_contacts` of them.
  int num_contacts =
      3;          ///< Used where `fingers` is empty: the thumb and the fingers after it, ≥ 2.
  int count = 1;  ///< Grasps to collect (K), ≥ 1.
  std::uint64_t seed = 1;
  SearchRule search = SearchRule::Best;
  int max_attempts = 50;  ///< Target sets fitted, ≥ 1; a budget of work, not of time (A20, A36).
  Acceptance acceptance = Acceptance::Valid;
  std::optional<Eigen::Vector3d> approach_O;  ///< Wanted palm direction in O; must be nonzero.
  std::optional<double>
      wall_clock_limit_s;  ///< Opt-in; makes results depend on the machine, and is recorded.
  int resolution = 30;     ///< Voxels along the object's longest extent [P].
  std::optional<double> clip_thickness;  ///< [m]; empty: max(0.5 voxel, 1 mm) (A33).
  geometry::PatchAveraging averaging = geometry::PatchAveraging::AreaWeighted;  ///< A6, A34.
  ScoreOptions score;
  TargetOptions targets;  ///< min_separation 0: one pad width is set by the planner.
  /// Target sets drawn per attempt, ≥ 1; the one on which the fingertip pads would lie flattest is
  /// fitted: contacts "the hand can plausibly reach" (paper section 1) read through the hand's
  /// kinematics [R]. 1: the paper's random set, the side with more room first.
  int target_draws = 8;
  FittingOptions fitting;
  double self_overlap =
      0.001;               ///< Overlap of links of different fingers that a formed grasp may have
                           ///< before it is rejected as a self-collision [m], ≥ 0 (A40) [R].
  QualityOptions quality;  ///< merge_distance 0: a tenth of a voxel is set by the planner.
  void validate() const;   ///< Throws InvalidInput naming the field and its value.
};

/// How the planner's work ended.
enum class PlannerStop { Count, Attempts, WallClock };

/// What became of the attempts: each ends in exactly one of these (names in `outcome_name`).
enum class AttemptOutcome {
  Valid,
  UsableOnly,  ///< Usable but penetrating or without a requested contact.
  NoTargets,   ///< No seed, no pair or no further contact.
  InitialCollision,
  BlockedFinger,
  MissedContact,
  SelfCollision,
  IterationLimit,
  Unstable,   ///< A formed grasp with no stable pair (M2 = 0).
  PoorShape,  ///< M3 ≤ 0, or M1 = 0.
};
const char* outcome_name(AttemptOutcome outcome);

/// Counters of a run. `attempts` is the sum of the outcomes.
struct PlannerStatistics {
  std::int64_t attempts = 0;
  std::map<AttemptOutcome, std::int64_t> outcomes;  ///< Every outcome is present, zeros included.
  std::map<std::string, std::int64_t> target_failures;  ///< "no seed", "no second", "no further".
  std::int64_t seeds_tried = 0;
  std::int64_t fitting_iterations = 0;
  std::int64_t usable() const;
  std::int64_t valid() const;
};

/// Seconds per stage; never part of results.
struct PlannerTimings {
  ObjectModelTimings object;
  double targets_s = 0.0;
  double fitting_s = 0.0;        ///< The loop, its contact tests included.
  double contact_tests_s = 0.0;  ///< Contact estimation inside the loop; a part of `fitting_s`.
  double measure_s = 0.0;        ///< Quality of formed grasps.
  double penetration_s = 0.0;    ///< Exact tests of usable grasps.
  double total_s = 0.0;
};

/// What a planner returns: grasps, best M first (ties by attempt), at most `count`.
struct PlannerResult {
  std::vector<Grasp> grasps;
  PlannerStop stop = PlannerStop::Attempts;
  PlannerStatistics statistics;
  PlannerTimings timings;
};

/// Called after each attempt with (attempts done, grasps found); may be empty.
using PlannerProgress = std::function<void(std::int64_t, std::int64_t)>;

/// The object prepared as `options` ask for and `hand` needs (margin: its largest reach).
/// @throws InvalidInput for an object that is smaller than a fingertip or thicker than the hand's
/// span.
ObjectModel prepare_object(const geometry::TriangleMesh& mesh, const hands::HandModel& hand,
                           const PlannerOptions& options, ObjectModelTimings* timings = nullptr);

/// Hand-object geometric fitting (paper section 11): target contacts, fitting, contacts, measure,
/// until `count` grasps are accepted or the budget is used.
///
/// @throws InvalidInput for options that the hand cannot meet (unknown finger, more contacts than
/// it allows) or an object of impossible size (says the extents): thicker in every direction than
/// the fingers open, or smaller than a fingertip.
PlannerResult plan_grasps(const ObjectModel& object, const hands::HandModel& hand,
                          const PlannerOptions& options, const PlannerProgress& progress = {});

/// The planner's rule for clip volumes (A33).
double clip_thickness(const PlannerOptions& options, double voxel_size);

/// The planner's rule for contacts that count as one [m]: a tenth of a voxel where `options` say 0.
double merge_distance(const PlannerOptions& options, double voxel_size);

/// The fingers that `options` ask of `hand`, the thumb first where it is among them (A22).
std::vector<int> requested_fingers(const hands::HandModel& hand, const PlannerOptions& options);

/// Contacts, M and penetration of a configuration, from the true meshes alone: what the planner
/// reports and what `evaluate` recomputes.
Grasp measure_grasp(const hands::HandModel& hand, const hands::HandCollision& collision,
                    const geometry::MeshQuery& object, const QualityContext& context,
                    const hands::HandConfiguration& configuration,
                    const std::vector<int>& requested_fingers,
                    const ContactEstimationOptions& contact_options,
                    const QualityOptions& quality_options);

}  // namespace graspfit::grasp
