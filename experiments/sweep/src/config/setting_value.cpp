#include "graspfit/sweep/setting_value.hpp"

#include <nlohmann/json.hpp>

#include "graspfit/sweep/experiment.hpp"

namespace graspfit::sweep {

using base::JsonValue;

JsonValue setting_value(std::string key, const nlohmann::json& json) {
  const auto fault = [](const std::string& where, const std::string& what) {
    throw SettingError(where, what);
  };
  return {JsonValue::Json(json), fault, std::move(key)};
}

std::optional<JsonValue> find_setting(const Cell& cell, const std::string& key) {
  const nlohmann::json settings = nlohmann::json::parse(cell.settings);
  if (!settings.contains(key)) return std::nullopt;
  return setting_value(key, settings.at(key));
}

JsonValue setting(const Cell& cell, const std::string& key) {
  const std::optional<JsonValue> value = find_setting(cell, key);
  if (!value) throw SettingError("", "there is no setting " + key);
  return *value;
}

Eigen::Vector3d vector_of(const JsonValue& value) {
  if (value.items().size() != 3) value.refuse("must be three numbers [x, y, z]");
  return Eigen::Vector3d(value.numbers<3>().data());
}

std::vector<std::string> names_of(const JsonValue& value) {
  std::vector<std::string> names;
  for (const JsonValue& item : value.some_items()) names.push_back(item.name());
  return names;
}

int axis_of(const JsonValue& value) {
  const std::string name = value.name();
  if (name != "x" && name != "y" && name != "z") value.refuse("must be one of x|y|z");
  return name[0] - 'x';
}

}  // namespace graspfit::sweep
