#include "graspfit/experiments/planning_settings.hpp"

#include <algorithm>
#include <cmath>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/list_text.hpp"
#include "graspfit/base/nearest_name.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/grasp/grasp_guidance.hpp"
#include "graspfit/grasp/option_names.hpp"
#include "settings/planning_setting_list.hpp"
#include "settings/planning_setting_schemas.hpp"

namespace graspfit::experiments {
namespace {

using internal::planning_setting_list;
using internal::PlanningSetting;
using Schema = nlohmann::ordered_json;

[[noreturn]] void fail_unknown(const std::string& key, const std::vector<sweep::Column>& others) {
  std::vector<std::string> names;
  for (const sweep::Column& other : others) names.push_back(other.name);
  for (const PlanningSetting& setting : planning_setting_list()) names.push_back(setting.name.name);
  throw sweep::SettingError(key, "is no setting; there are " + base::known_names(key, names));
}

/// "in [0, 1]", "> 0 [mm]".
std::string range_text(const PlanningSetting& setting) {
  const std::string& unit = setting.name.unit;
  return setting.range->text() + (unit.empty() || unit == "1" ? "" : " [" + unit + ']');
}

/// "a|b|c", "true|false", "in [0, 1]", "text", "[number, ...]".
std::string allowed_text(const PlanningSetting& setting) {
  if (setting.range) return setting.range->text();
  if (setting.schema.contains("enum")) {
    return base::list_text(setting.schema.at("enum").get<std::vector<std::string>>(), {}, "|");
  }
  const std::string type = setting.schema.at("type").get<std::string>();
  if (type == "boolean") return "true|false";
  if (type == "string") return "text";
  if (type != "array") return type;
  const std::string item = setting.schema.at("items").at("type") == "string" ? "text" : "number";
  return setting.schema.contains("maxItems") ? '[' + item + ", " + item + ", " + item + ']'
                                             : '[' + item + ", ...]";
}

/// The setting's JSON Schema with its range.
Schema whole_schema(const PlanningSetting& setting) {
  Schema schema = setting.schema;
  if (const auto& range = setting.range) {
    if (std::isfinite(range->least)) {
      schema[range->has_least ? "minimum" : "exclusiveMinimum"] = range->least;
    }
    if (std::isfinite(range->most)) {
      schema[range->has_most ? "maximum" : "exclusiveMaximum"] = range->most;
    }
  }
  const std::string& unit = setting.name.unit;
  schema["description"] =
      setting.name.meaning + (unit.empty() || unit == "1" ? "" : " [" + unit + ']');
  return schema;
}

std::string millimeters_text(double meters) {
  return base::plain_decimal(std::round(meters * 1e12) / 1e9);
}

}  // namespace

const std::vector<sweep::Column>& planning_setting_names() {
  static const std::vector<sweep::Column> names = [] {
    std::vector<sweep::Column> columns;
    for (const PlanningSetting& setting : planning_setting_list()) columns.push_back(setting.name);
    return columns;
  }();
  return names;
}

const std::vector<SettingDescription>& planning_setting_descriptions() {
  static const std::vector<SettingDescription> descriptions = [] {
    std::vector<SettingDescription> all;
    for (const PlanningSetting& setting : planning_setting_list()) {
      all.push_back({setting.name, allowed_text(setting), setting.fallback, setting.range});
    }
    return all;
  }();
  return descriptions;
}

const Schema& internal::planning_setting_schemas() {
  static const Schema schemas = [] {
    Schema all;
    for (const PlanningSetting& setting : planning_setting_list()) {
      all[setting.name.name] = whole_schema(setting);
    }
    return all;
  }();
  return schemas;
}

void require_compatible(const grasp::PlannerOptions& options) {
  const bool has_palm = options.palm.value_or(options.style == grasp::GraspStyle::Power);
  const int num_fingers =
      options.fingers.empty() ? options.num_contacts : base::as_index<int>(options.fingers.size());
  if (num_fingers < 2 && !has_palm) {
    throw sweep::SettingError(
        options.fingers.empty() ? "contacts" : "fingers",
        "asks for " + std::to_string(num_fingers) +
            " finger, must be at least two without the palm; more fingers, or palm");
  }
  if (options.approach_O && !(options.approach_O->norm() > 0.0)) {
    throw sweep::SettingError("approach",
                              "is a direction without length; give one that is not zero");
  }
  if (options.score.neighborhood % 2 == 0) {
    throw sweep::SettingError("neighborhood",
                              "is " + std::to_string(options.score.neighborhood) + ", must be odd");
  }
  const grasp::RefinementOptions& limits = options.refinement;
  const auto require_order = [](const char* name, double smaller, const char* rule,
                                const char* other, double larger, bool is_met) {
    if (is_met) return;
    throw sweep::SettingError(name, "is " + millimeters_text(smaller) + ", must be " + rule + ' ' +
                                        other + ", which is " + millimeters_text(larger) +
                                        "; change one of them");
  };
  require_order("wanted-gap-mm", limits.wanted_gap, "below", "largest-gap-mm", limits.largest_gap,
                limits.wanted_gap < limits.largest_gap);
  require_order("least-distance-mm", limits.least_distance, "at most", "wanted-gap-mm",
                limits.wanted_gap, limits.least_distance <= limits.wanted_gap);
  if (options.refine && options.missing_contact != grasp::MissingContact::Fails) {
    throw sweep::SettingError(
        "missing-contact",
        "is " + std::string(grasp::name_of(options.missing_contact)) +
            ", must be fails with refine, which accepts no part without contact; "
            "turn refine off");
  }
  if (options.rejection == grasp::Rejection::Deviation &&
      !grasp::planning_methods().at(options.planner).has_targets) {
    throw sweep::SettingError("reject",
                              "is deviation, and planner " + options.planner +
                                  " has no targets that contacts could be far from; reject none "
                                  "or quality");
  }
}

PlanningSettings planning_settings(const std::string& text, std::uint64_t seed,
                                   const std::vector<sweep::Column>& others) {
  const nlohmann::json json = nlohmann::json::parse(text);
  PlanningSettings settings;
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  std::stable_partition(keys.begin(), keys.end(),
                        [](const std::string& key) { return key == internal::kPresetSetting; });
  for (const std::string& key : keys) {
    const nlohmann::json& value = json.at(key);
    if (std::any_of(others.begin(), others.end(),
                    [&](const sweep::Column& other) { return other.name == key; })) {
      continue;
    }
    const auto found =
        std::find_if(planning_setting_list().begin(), planning_setting_list().end(),
                     [&](const PlanningSetting& setting) { return setting.name.name == key; });
    if (found == planning_setting_list().end()) fail_unknown(key, others);
    const base::JsonValue given = sweep::setting_value(key, value);
    const bool is_outside =
        found->range && value.is_number() && !found->range->contains(value.get<double>());
    if (is_outside) given.refuse("must be " + range_text(*found));
    found->apply(settings, given);
  }
  const ObjectSettings& object = settings.object;
  if (!object.file.empty() + !object.packaged.empty() + !object.shape.empty() != 1) {
    throw sweep::SettingError(
        "", "an object is a file, a packaged mesh or a shape; set one of the three");
  }
  if (settings.hand.empty()) throw sweep::SettingError("", "there is no setting hand");
  settings.options.seed = seed;
  require_compatible(settings.options);
  if (settings.options.rank == grasp::RankRule::Margin) {
    throw sweep::SettingError("rank", "is margin, which no planner finds; m or epsilon");
  }
  try {
    settings.options.validate();
  } catch (const base::InvalidInput& error) {
    throw sweep::SettingError("", error.what());
  }
  return settings;
}

PlanningSettings planning_settings(const sweep::Cell& cell,
                                   const std::vector<sweep::Column>& others) {
  return planning_settings(cell.settings, cell.seed, others);
}

}  // namespace graspfit::experiments
