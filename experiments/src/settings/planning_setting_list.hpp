#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/base/number_range.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/sweep/setting_value.hpp"

namespace graspfit::experiments::internal {

/// A setting by name: the one place that says what it means and which values it may have.
struct PlanningSetting {
  sweep::Column name;
  nlohmann::ordered_json schema;  ///< JSON Schema of its values, but for `range`.
  /// Sets what it names, from any value of the right type: `range` is checked beforehand.
  std::function<void(PlanningSettings&, const base::JsonValue&)> apply;
  std::optional<base::NumberRange> range = {};  ///< In `name.unit`.
  std::string fallback = "";  ///< Its value where it is not given, as text; empty: none.
};

/// Names a preset. It is applied before all other settings.
inline constexpr const char* kPresetSetting = "preset";

/// All settings of `planning_setting_names`, in that order.
const std::vector<PlanningSetting>& planning_setting_list();

}  // namespace graspfit::experiments::internal
