#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "graspfit/grasp/planner_option_table.hpp"

namespace graspfit::grasp {

/// A named set of option values. Options that are set after a preset replace the preset's values.
struct PlannerPreset {
  std::string_view name;
  std::string_view meaning;  ///< A sentence without its full stop.
  /// Names of options of the table with their values; the others have their defaults.
  std::vector<std::pair<std::string_view, OptionValue>> values;
};

/// The preset of `graspfit plan` without flags that contradict it: "strong". Programs that use the
/// library start from the defaults of `PlannerOptions`, which are those of the preset "exact".
inline constexpr std::string_view kDefaultPreset = "strong";

/// "paper", "exact", "fast" and "strong".
const std::vector<PlannerPreset>& planner_presets();

/// The preset of that name; null if there is none.
const PlannerPreset* preset_named(std::string_view name);

/// "strongest", "24", "true": a value of a preset as a setting has it.
std::string value_text(const OptionValue& value);

/// Sets the options of a preset. Precondition: it is one of `planner_presets`, or its values are as
/// `set_option` wants them.
void apply_preset(PlannerOptions& options, const PlannerPreset& preset);

}  // namespace graspfit::grasp
