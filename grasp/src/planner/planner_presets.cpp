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
      {"exact",
       "the paper's method with exact contacts: grasps that touch where asked, are clear of "
       "everything and can be reached",
       {}},
      {"fast", "as exact, the first valid grasps", {{"search", named("first")}}},
      {kDefaultPreset,
       "grasps that close and hold: the hand is laid onto the object first, and targets are where "
       "its pads lie, those that withstand most first",
       {{"style", named("auto")},
        {"target-search", named("reach")},
        {"keep", named("firmest")},
        {"max-redraws", std::int64_t{5}},
        {"idle-fingers", named("close")},
        {"contact-faces", named("facing")},
        {"count", std::int64_t{5}},
        {"search", named("closed")},
        {"rank", named("epsilon")}}}};
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
