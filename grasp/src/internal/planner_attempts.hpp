#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "graspfit/geometry/random.hpp"
#include "graspfit/grasp/fitting_hand.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/grasp/hand_fitting.hpp"
#include "graspfit/grasp/target_contacts.hpp"

namespace graspfit::grasp::internal {

/// What one attempt came to.
struct AttemptResult {
  AttemptOutcome outcome = AttemptOutcome::NoTargets;
  bool is_exhausted = false;  ///< Ranked search had no further target set: not an attempt at all.
  std::optional<TargetFailure> target_failure;
  std::optional<Grasp> grasp;  ///< Where the outcome is Valid or UsableOnly.
  bool is_accepted = false;    ///< The grasp is one of those looked for.
  std::int64_t seeds_tried = 0;
  std::int64_t fitting_iterations = 0;
  std::int64_t refinement_iterations = 0;
  PlannerTimings timings;
};

/// The attempts of one run of the planner: what stays the same over all of them. An attempt depends
/// on its number alone, so they can be made in any order and by several threads.
class PlannerAttempts {
 public:
  PlannerAttempts(const ObjectModel& object, const hands::HandModel& hand,
                  const PlannerOptions& options, const Surroundings& surroundings);

  AttemptResult make(std::int64_t number) const;

 private:
  /// Assigned targets and the side from which to reach for them.
  struct Start {
    TargetContacts targets;
    PalmPlacement placement;
    double misfit = 0.0;
  };

  std::vector<Start> draw_starts(std::int64_t number, AttemptResult& result) const;
  int num_draws() const;
  std::vector<Start> starts_of(const TargetContacts& targets) const;
  std::optional<TargetContacts> ranked_targets(std::int64_t number) const;
  AttemptResult try_start(const Start& start, std::int64_t number) const;
  std::optional<AttemptOutcome> fit(const Start& start, hands::HandConfiguration& configuration,
                                    AttemptResult& result) const;
  std::optional<AttemptOutcome> refine(const TargetContacts& targets,
                                       hands::HandConfiguration& configuration,
                                       AttemptResult& result) const;
  void complete(Grasp& grasp, AttemptResult& result) const;
  double ideal_m(const TargetContacts& targets) const;
  double angle_from_approach(const hands::HandConfiguration& configuration) const;
  bool are_scores_high(const std::vector<Contact>& contacts) const;
  bool is_accepted(const Grasp& grasp) const;

  const ObjectModel& object_;
  const hands::HandModel& hand_;
  const PlannerOptions options_;
  const RequestedParts parts_;
  const FittingHand fitting_hand_;
  const PartDistances distances_;
  const SurroundingsCollision surroundings_;
  const MeasuringScene scene_;
  std::vector<int> claimed_pads_;
  std::optional<TargetSelector> selector_;  ///< Of the random search.
  mutable std::mutex ranked_lock_;
  mutable std::optional<RankedTargets> ranked_;
  mutable std::vector<TargetContacts> ranked_sets_;  ///< Those that `ranked_` gave so far.
};

/// How far an attempt that ended so had come, for telling better failures from worse.
int stage_of(AttemptOutcome outcome);

const char* failure_name(TargetFailure failure);

}  // namespace graspfit::grasp::internal
