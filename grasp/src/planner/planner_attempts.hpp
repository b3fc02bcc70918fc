#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "graspfit/grasp/grasp_guidance.hpp"
#include "graspfit/grasp/grasp_measure.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/grasp/planner_options.hpp"
#include "graspfit/grasp/planner_result.hpp"

namespace graspfit::grasp::internal {

/// What one attempt came to.
struct AttemptResult {
  AttemptOutcome outcome = AttemptOutcome::NoTargets;
  bool is_exhausted = false;  ///< The method had nothing left to try: not an attempt at all.
  std::optional<std::string> target_failure;
  std::optional<Grasp> grasp;  ///< Where the outcome is Valid or UsableOnly.
  /// Of the grasp's configuration, while starts of the attempt are compared; empty once it is made.
  std::vector<hands::RigidTransform> X_OL;
  bool is_accepted = false;  ///< Whether the options accept the grasp.
  /// Of the grasp, where `KeptCandidate::Firmest` compares it.
  double firmness = -std::numeric_limits<double>::infinity();
  /// The grasp's pre-grasp was not searched for yet, and is assumed to exist until then; ε is not
  /// known yet either, nor perhaps its squeeze.
  bool is_way_in_open_question = false;
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
                  const PlannerOptions& options, const Surroundings& surroundings,
                  const PlanningMethods& methods);

  /// @param observer called for every start that is tried; may be empty.
  AttemptResult make(std::int64_t number, const TriedStartObserver& observer = {}) const;

  const GraspGuidance& guidance() const { return *guidance_; }
  double guidance_s() const { return guidance_s_; }  ///< What it took to prepare.
  /// What `RankRule` and `KeptCandidate::Strongest` compare: ε, signed, of the contacts
  /// that touch, with the friction cones of the squeeze.
  double strength(const Grasp& grasp) const;

 private:
  /// Whether the grasp is accepted, the stage reached, and what `KeptCandidate` compares: whether
  /// the squeeze is balanced, and a number.
  using StartRank = std::tuple<bool, int, bool, double>;

  double firmness_of(const Grasp& grasp) const;
  AttemptResult try_start(const GuidedStart& start, std::int64_t number) const;
  /// How closing or refinement ended.
  struct Reached {
    hands::HandConfiguration configuration;  ///< The final one, whether it failed or not.
    std::optional<AttemptOutcome> failure;
  };

  Reached close(const GuidedStart& start, AttemptResult& work) const;
  Reached refine(const hands::HandConfiguration& closed, const std::vector<int>& pads,
                 const TargetContacts* targets, AttemptResult& work) const;
  std::size_t try_starts(const std::vector<GuidedStart>& starts, std::int64_t number,
                         const TriedStartObserver& observer,
                         std::vector<AttemptResult>& tried) const;
  std::size_t best_of(const std::vector<AttemptResult>& tried) const;
  std::size_t best_with_way_in(std::vector<AttemptResult>& tried) const;
  contact::Squeeze squeeze_of(const AttemptResult& result) const;
  AttemptResult with_way_in(AttemptResult result) const;
  double angle_from_approach(const hands::HandConfiguration& configuration) const;
  bool are_scores_high(const std::vector<contact::Contact>& contacts) const;
  bool is_accepted(const Grasp& grasp) const;
  StartRank rank_of(const AttemptResult& result) const;
  bool is_rejected(const Grasp& grasp) const;
  bool is_enough(const AttemptResult& result, double promise) const;
  bool may_be_kept(const AttemptResult& result, int num_draws) const;

  const ObjectModel& object_;
  const hands::HandModel& hand_;
  const PlannerOptions options_;
  const RequestedParts parts_;
  const FittingHand fitting_hand_;
  const SurroundingsCollision surroundings_;
  const MeasuringScene scene_;
  const double largest_deviation_;  ///< From targets [m].
  std::unique_ptr<GraspGuidance> guidance_;
  double guidance_s_ = 0.0;
};

}  // namespace graspfit::grasp::internal
