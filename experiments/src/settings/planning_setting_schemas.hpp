#pragma once

#include <nlohmann/json_fwd.hpp>

namespace graspfit::experiments::internal {

/// The JSON Schema of every setting of `planning_setting_names`, by name.
const nlohmann::ordered_json& planning_setting_schemas();

}  // namespace graspfit::experiments::internal
