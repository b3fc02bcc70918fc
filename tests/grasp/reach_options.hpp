#pragma once

#include "graspfit/grasp/planner_options.hpp"

namespace graspfit::testing {

/// Returns options of a search by the hand's reach that keeps what all its attempts find, without a
/// look for fragile features.
inline grasp::PlannerOptions reach_options(grasp::GraspStyle style, int max_attempts) {
  grasp::PlannerOptions options;
  options.targets.search = grasp::TargetSearch::Reach;
  options.style = style;
  options.max_attempts = max_attempts;
  options.count = max_attempts;
  options.weak.reset();
  return options;
}

}  // namespace graspfit::testing
