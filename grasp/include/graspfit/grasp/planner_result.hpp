#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "graspfit/grasp/grasp.hpp"
#include "graspfit/grasp/object_model.hpp"

namespace graspfit::grasp {

/// How the planner's work ended.
enum class PlannerStop {
  Count,        ///< As many grasps as were asked for.
  Attempts,     ///< All attempts made.
  Exhausted,    ///< Ranked search: every feasible target set was tried; ma: every candidate.
  WallClock,    ///< Opt-in limit.
  Iterations,   ///< The budget of fitting and refinement steps is used up.
  Interrupted,  ///< The caller asked for a stop.
};

/// What became of the attempts: each ends in exactly one of these (names in `outcome_name`).
enum class AttemptOutcome {
  Valid,
  /// Usable, but penetrating, without a requested contact, with the palm direction outside the cone
  /// of approach, or with a contact where the score is too low.
  UsableOnly,
  NoTargets,  ///< The method had no start; with fitting: no seed, no pair, no further contact or no
              ///< target of the palm.
  InitialCollision,
  BlockedFinger,
  MissedContact,
  GapLeft,  ///< Refinement could not bring every requested pad to touch.
  SelfCollision,
  Rejected,  ///< Usable, but not as `PlannerOptions::rejection` wants it.
  NoWayIn,   ///< No pre-grasp with a collision-free path to the grasp.
  IterationLimit,
  Weak,       ///< All contacts on weak features (M1 = 0).
  Unstable,   ///< A formed grasp with no stable pair (M2 = 0).
  PoorShape,  ///< M3 ≤ 0, or M1 = 0.
};
const char* outcome_name(AttemptOutcome outcome);

/// What two fingertips of the hand can pinch squarely at `PlannerOptions::friction`, from the
/// narrowest to the widest: names in `PlannerStatistics::guidance` of a search by reach.
inline constexpr std::string_view kNarrowestPinch = "narrowest square pinch (mm)";
inline constexpr std::string_view kWidestPinch = "widest square pinch (mm)";

/// Counters of a run. `attempts` is the sum of the outcomes.
struct PlannerStatistics {
  std::int64_t attempts = 0;
  std::map<AttemptOutcome, std::int64_t> outcomes;  ///< Every outcome is present, zeros included.
  std::map<std::string, std::int64_t> target_failures;  ///< "no seed", "no second", …, "no palm".
  std::map<std::string, std::int64_t> guidance;  ///< What the method found in its preparation.
  std::int64_t seeds_tried = 0;
  std::int64_t fitting_iterations = 0;
  std::int64_t refinement_iterations = 0;
  /// Accepted grasps left out because they are too like one that is returned or was found before;
  /// `outcomes` counts them under their own outcome.
  std::int64_t duplicates = 0;
  std::int64_t usable() const;
  std::int64_t valid() const;
};

/// Seconds per stage; never part of results.
struct PlannerTimings {
  ObjectModelTimings object;
  double guidance_s = 0.0;       ///< The method's preparation, once per run: samples, medial balls.
  double targets_s = 0.0;        ///< Starts of attempts: target contacts.
  double fitting_s = 0.0;        ///< The loop, its contact tests included.
  double contact_tests_s = 0.0;  ///< Contact estimation inside the loop; a part of `fitting_s`.
  double refinement_s = 0.0;     ///< Refinement of contacts.
  double measure_s = 0.0;        ///< Contacts, measures and exact tests of formed grasps.
  double pre_grasp_s = 0.0;      ///< Pre-grasps with their paths, and squeezes.
  double total_s = 0.0;          ///< By the clock; the others add up over all threads.

  /// Adds the stages of attempts; `object`, `guidance_s` and `total_s` stay.
  PlannerTimings& operator+=(const PlannerTimings& other);
};

/// What a planner returns: grasps, the best by `RankRule` first (ties by attempt), at most `count`.
struct PlannerResult {
  std::vector<Grasp> grasps;
  PlannerStop stop = PlannerStop::Attempts;
  PlannerStatistics statistics;
  PlannerTimings timings;
};

}  // namespace graspfit::grasp
