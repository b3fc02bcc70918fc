#include "graspfit/grasp/planner_presets.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <variant>

namespace graspfit::grasp {
namespace {

template <class Items>
auto find_by_name(const Items& items, std::string_view name) {
  return std::find_if(items.begin(), items.end(),
                      [&](const auto& item) { return item.name == name; });
}

OptionValue named(const char* value) { return std::string(value); }

}  // namespace

const std::vector<PlannerPreset>& planner_presets() {
  static const std::vector<PlannerPreset> presets = {
      {"paper",
       "the paper's method as far as it states it, at the level of voxels: grasps with M > 0, "
       "without exact contact and without a way there",
       {{"refine", false},
        {"guard", named("voxels")},
        {"accept", named("usable")},
        {"reject", named("deviation")},
        {"pre-grasps", false}}},
      {"fast", "the first valid grasps", {{"search", named("first")}}},
      {"strong",
       "grasps that close and hold: of many sides an attempt keeps the one that withstands most",
       {{"candidate-order", named("balance")},
        {"keep", named("strongest")},
        {"max-placements", std::int64_t{24}}}}};
  return presets;
}

const PlannerPreset* preset_named(std::string_view name) {
  const auto found = find_by_name(planner_presets(), name);
  return found == planner_presets().end() ? nullptr : &*found;
}

std::string value_text(const OptionValue& value) {
  if (const bool* const is_yes = std::get_if<bool>(&value)) return *is_yes ? "true" : "false";
  if (const auto* const number = std::get_if<std::int64_t>(&value)) return std::to_string(*number);
  return std::get<std::string>(value);
}

void apply_preset(PlannerOptions& options, const PlannerPreset& preset) {
  for (const auto& [name, value] : preset.values) {
    set_option(options, *find_by_name(planner_option_table(), name), value);
  }
}

}  // namespace graspfit::grasp
