#include "settings/planning_setting_list.hpp"

#include <cstdint>
#include <optional>

#include "graspfit/base/list_text.hpp"
#include "graspfit/base/units.hpp"
#include "graspfit/grasp/planner_option_table.hpp"
#include "graspfit/grasp/planner_presets.hpp"

namespace graspfit::experiments::internal {
namespace {

using base::JsonValue;
using grasp::OptionKind;
using grasp::OptionValue;
using grasp::PlannerOption;
using Schema = nlohmann::ordered_json;

Schema of_type(const char* type) { return {{"type", type}}; }
Schema text() { return {{"type", "string"}, {"minLength", 1}}; }
Schema three_numbers() {
  return {{"type", "array"}, {"items", of_type("number")}, {"minItems", 3}, {"maxItems", 3}};
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const grasp::PlannerPreset& preset : grasp::planner_presets())
    names.emplace_back(preset.name);
  return names;
}

std::vector<PlanningSetting> object_and_hand_settings() {
  return {
      {{"file", "", "the object's mesh in the data folder"},
       text(),
       [](PlanningSettings& s, const JsonValue& v) { s.object.file = v.name(); }},
      {{"packaged", "", "instead of file: a mesh of libcgal-demo, by the name of its file"},
       text(),
       [](PlanningSettings& s, const JsonValue& v) {
         s.object.packaged = v.name();
         if (v.name().find('/') != std::string::npos) v.refuse("must be a file's name, no path");
       }},
      {{"shape", "", "instead of file: a shape of graspfit shape"},
       text(),
       [](PlanningSettings& s, const JsonValue& v) { s.object.shape = v.name(); }},
      {{"size_m", "m", "length of the object's bounding box along size_axis"},
       of_type("number"),
       [](PlanningSettings& s, const JsonValue& v) { s.object.size = v.number(); },
       base::above(0)},
      {{"size_axis", "", "edge of the bounding box that size_m is for"},
       {{"enum", {"x", "y", "z", "longest"}}},
       [](PlanningSettings& s, const JsonValue& v) {
         if (v.name() != "longest") s.object.size_axis = sweep::axis_of(v);
       },
       {},
       "longest"},
      {{"meters_per_unit", "m", "length of a unit of the object's file, where no size_m is given"},
       of_type("number"),
       [](PlanningSettings& s, const JsonValue& v) { s.object.meters_per_unit = v.number(); },
       base::above(0)},
      {{"largest_thickness_m", "m", "scaled down where the bounding box's shortest edge is longer"},
       of_type("number"),
       [](PlanningSettings& s, const JsonValue& v) { s.object.largest_thickness = v.number(); },
       base::above(0)},
      {{"rotation_deg", "deg",
        "[x, y, z]: the object is turned before planning, about its frame's x, then y, then z "
        "axis"},
       three_numbers(),
       [](PlanningSettings& s, const JsonValue& v) {
         s.object.rotation_xyz = sweep::vector_of(v) * base::kRadiansPerDegree;
       }},
      {{"rest_pose", "1",
        "the object is laid down on a table at z = 0, in the pose of this rank among its rest "
        "poses, the likeliest being 1"},
       of_type("integer"),
       [](PlanningSettings& s, const JsonValue& v) { s.object.rest_pose = v.small_integer(); },
       base::at_least(1)},
      {{"hand", "", "a shipped hand, or a description in the data folder"},
       text(),
       [](PlanningSettings& s, const JsonValue& v) { s.hand = v.name(); }},
      {{"table", "m", "a table: everything at or below this z of the object's frame is solid"},
       of_type("number"),
       [](PlanningSettings& s, const JsonValue& v) { s.table_z_O = v.number(); }},
      {{kPresetSetting, "",
        "options of the planner that go together; what else is set changes them"},
       {{"enum", preset_names()}},
       [](PlanningSettings& s, const JsonValue& v) {
         const grasp::PlannerPreset* const preset = grasp::preset_named(v.name());
         if (preset == nullptr)
           v.refuse("must be one of " + base::list_text(preset_names(), {}, "|"));
         grasp::apply_preset(s.options, *preset);
         s.preset = v.name();
       }}};
}

Schema schema_of(const PlannerOption& option) {
  switch (option.kind) {
    case OptionKind::Number:
      return of_type("number");
    case OptionKind::Integer:
      return of_type("integer");
    case OptionKind::YesNo:
      return of_type("boolean");
    case OptionKind::Choice:
      return {{"enum", option.choices}};
    case OptionKind::Names:
      return {{"type", "array"}, {"items", text()}, {"minItems", 1}};
    case OptionKind::Direction:
      return three_numbers();
  }
  return {};
}

OptionValue value_of(const PlannerOption& option, const JsonValue& value) {
  switch (option.kind) {
    case OptionKind::Number:
      return value.number();
    case OptionKind::Integer:
      return std::int64_t{value.small_integer()};
    case OptionKind::YesNo:
      return value.flag();
    case OptionKind::Names:
      return sweep::names_of(value);
    case OptionKind::Direction:
      return sweep::vector_of(value);
    case OptionKind::Choice:
      break;
  }
  const std::string name = value.name();
  if (!option.has_choice(name)) value.refuse("must be one of " + option.choices_text());
  return name;
}

PlanningSetting setting_of(const PlannerOption& option) {
  // Settings say 0 where flags say --no-weak.
  const bool may_be_none = option.name == "weak-thickness-mm";
  return {{std::string(option.name), option.is_number() ? std::string(option.unit) : "",
           std::string(option.meaning) + (may_be_none ? "; 0: none are looked for" : "")},
          schema_of(option),
          [&option](PlanningSettings& settings, const JsonValue& value) {
            grasp::set_option(settings.options, option, value_of(option, value));
          },
          option.is_number() ? std::optional(may_be_none ? base::at_least(0) : option.range)
                             : std::nullopt,
          option.fallback};
}

}  // namespace

const std::vector<PlanningSetting>& planning_setting_list() {
  static const std::vector<PlanningSetting> settings = [] {
    std::vector<PlanningSetting> all = object_and_hand_settings();
    for (const PlannerOption& option : grasp::planner_option_table()) {
      if (option.is_setting) all.push_back(setting_of(option));
    }
    return all;
  }();
  return settings;
}

}  // namespace graspfit::experiments::internal
