#pragma once

#include <string>
#include <utility>
#include <vector>

#include "graspfit/grasp/grasp_planner.hpp"

namespace graspfit::grasp::internal {

/// What the planner does at each point that the paper leaves open: the point's number in
/// docs/readings.md and the reading chosen, by name. Points without an option have one reading.
std::vector<std::pair<std::string, std::string>> planner_readings(const PlannerOptions& options);

}  // namespace graspfit::grasp::internal
