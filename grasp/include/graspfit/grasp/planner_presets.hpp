#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "graspfit/grasp/planner_option_table.hpp"

namespace graspfit::grasp {

/// Options that go together, by name. What else is set after a preset changes it.
struct PlannerPreset {
  std::string_view name;
  std::string_view meaning;  ///< A sentence without its full stop.
  /// Names of options of the table with their values.
  std::vector<std::pair<std::string_view, OptionValue>> values;
};

/// "paper", "fast" and "strong". Without a preset all options have their defaults.
const std::vector<PlannerPreset>& planner_presets();

/// The preset of that name; null if there is none.
const PlannerPreset* preset_named(std::string_view name);

/// Sets the options of a preset.
void apply_preset(PlannerOptions& options, const PlannerPreset& preset);

}  // namespace graspfit::grasp
