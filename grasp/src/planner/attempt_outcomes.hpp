#pragma once

#include <optional>

#include "graspfit/grasp/contact_refinement.hpp"
#include "graspfit/grasp/grasp.hpp"
#include "graspfit/grasp/hand_fitting.hpp"
#include "graspfit/grasp/planner_result.hpp"

namespace graspfit::grasp::internal {

/// Why M is zero.
AttemptOutcome unusable_outcome(const Grasp& grasp);

/// The failure of an attempt whose closing ended so; empty if it did not fail.
std::optional<AttemptOutcome> failure_of(FittingStop stop);

/// The failure of an attempt whose refinement ended so; empty if it did not fail.
std::optional<AttemptOutcome> failure_of(RefinementStop stop);

/// How far an attempt that ended so had come, for telling better failures from worse.
int stage_of(AttemptOutcome outcome);

}  // namespace graspfit::grasp::internal
