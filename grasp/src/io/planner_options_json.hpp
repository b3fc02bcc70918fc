#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "graspfit/grasp/planner_options.hpp"
#include "io/json_node.hpp"

namespace graspfit::grasp::internal {

/// Every option of the planner but for the seed, as grasp files hold it.
nlohmann::ordered_json planner_options_json(const PlannerOptions& options);

/// The options of such an object, validated. @throws IoError (file, place, what).
PlannerOptions read_planner_options(const JsonNode& node, std::uint64_t seed);

}  // namespace graspfit::grasp::internal
