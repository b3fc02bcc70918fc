#include "graspfit/sweep/setting_value.hpp"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "graspfit/base/nearest_name.hpp"
#include "graspfit/sweep/experiment.hpp"

namespace graspfit::sweep {

void SettingValue::fail(const std::string& rule) const {
  throw SettingError(key_, "is " + json_->dump() + ", " + rule);
}

bool SettingValue::has(const std::string& member) const {
  return json_->is_object() && json_->contains(member);
}

double SettingValue::number() const {
  if (!json_->is_number()) fail("must be a number");
  return json_->get<double>();
}

double SettingValue::positive_number() const {
  const double value = number();
  if (!(value > 0.0)) fail("must be > 0");
  return value;
}

int SettingValue::integer() const {
  if (!json_->is_number_integer()) fail("must be an integer");
  const double value = json_->get<double>();
  if (std::abs(value) > static_cast<double>(std::numeric_limits<int>::max())) {
    fail("must be an integer of at most 10 digits");
  }
  return json_->get<int>();
}

bool SettingValue::yes_or_no() const {
  if (!json_->is_boolean()) fail("must be true or false");
  return json_->get<bool>();
}

std::string SettingValue::text() const {
  if (!json_->is_string() || json_->get_ref<const std::string&>().empty()) fail("must be a text");
  return json_->get<std::string>();
}

std::vector<SettingValue> SettingValue::items() const {
  if (!json_->is_array() || json_->empty()) fail("must be an array with at least one value");
  std::vector<SettingValue> values;
  for (const nlohmann::json& item : *json_) {
    values.emplace_back(key_ + '/' + std::to_string(values.size()), item);
  }
  return values;
}

std::vector<std::string> SettingValue::texts() const {
  std::vector<std::string> texts;
  for (const SettingValue& item : items()) texts.push_back(item.text());
  return texts;
}

Eigen::Vector3d SettingValue::vector3() const {
  const std::vector<SettingValue> values = items();
  if (values.size() != 3) fail("must be three numbers [x, y, z]");
  return {values[0].number(), values[1].number(), values[2].number()};
}

int SettingValue::axis() const {
  const std::string name = text();
  if (name != "x" && name != "y" && name != "z") fail("must be one of x|y|z");
  return name[0] - 'x';
}

SettingValue SettingValue::at(const std::string& member) const {
  if (!json_->is_object()) fail("must be an object");
  const auto found = json_->find(member);
  if (found == json_->end()) throw SettingError(key_ + '/' + member, "is missing");
  return {key_ + '/' + member, *found};
}

void SettingValue::require_members_among(const std::vector<std::string>& allowed) const {
  if (!json_->is_object()) fail("must be an object");
  for (const auto& [member, value] : json_->items()) {
    if (std::find(allowed.begin(), allowed.end(), member) != allowed.end()) continue;
    throw SettingError(key_ + '/' + member, "is not a member that is known here; there are " +
                                                base::known_names(member, allowed));
  }
}

}  // namespace graspfit::sweep
