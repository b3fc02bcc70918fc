#pragma once

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace graspfit::sweep {

/// The value of a setting. All members throw SettingError that names it and says what is allowed.
class SettingValue {
 public:
  SettingValue(std::string key, const nlohmann::json& json) : key_(std::move(key)), json_(&json) {}

  const std::string& key() const { return key_; }
  const nlohmann::json& json() const { return *json_; }

  double number() const;
  double positive_number() const;
  int integer() const;
  bool yes_or_no() const;  ///< true or false.
  std::string text() const;
  std::vector<std::string> texts() const;  ///< Of an array.
  Eigen::Vector3d vector3() const;         ///< [x, y, z].
  std::vector<SettingValue> items() const;
  /// The axis "x", "y" or "z" as 0, 1, 2.
  int axis() const;
  bool has(const std::string& member) const;
  SettingValue at(const std::string& member) const;
  /// Throws unless this is an object with no other members.
  void require_members_among(const std::vector<std::string>& allowed) const;

  /// Throws "is VALUE, RULE".
  [[noreturn]] void fail(const std::string& rule) const;

 private:
  std::string key_;  ///< With the way to a nested value: "predicates/0/axis".
  const nlohmann::json* json_;
};

}  // namespace graspfit::sweep
