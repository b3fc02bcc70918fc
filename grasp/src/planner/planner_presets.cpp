#include "graspfit/grasp/planner_presets.hpp"

#include <algorithm>
#include <string>

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
       "the paper's grasps, at the level of voxels: M of the contacts that come about, without "
       "exact contact and without a way there",
       {{"refine", false},
        {"guard", named("voxels")},
        {"accept", named("usable")},
        {"missing-contact", named("measured")},
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

void apply_preset(PlannerOptions& options, const PlannerPreset& preset) {
  for (const auto& [name, value] : preset.values) {
    set_option(options, *find_by_name(planner_option_table(), name), value);
  }
}

}  // namespace graspfit::grasp
