#pragma once

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/base/json_value.hpp"
#include "graspfit/sweep/parameter_sweep.hpp"

/// \file
/// Settings of cells as values whose faults are SettingErrors: they name the setting, with the path
/// to a nested value ("predicates/0/axis"), and say what is allowed.

namespace graspfit::sweep {

/// A value that stands under `key` among the settings.
base::JsonValue setting_value(std::string key, const nlohmann::json& json);

/// A setting of a cell; none if the cell does not have it.
std::optional<base::JsonValue> find_setting(const Cell& cell, const std::string& key);
/// Returns a setting of a cell. @throws SettingError with an empty key if the cell does not have
/// it.
base::JsonValue setting(const Cell& cell, const std::string& key);

Eigen::Vector3d vector_of(const base::JsonValue& value);          ///< [x, y, z].
std::vector<std::string> names_of(const base::JsonValue& value);  ///< At least one.
/// The axis "x", "y" or "z" as 0, 1, 2.
int axis_of(const base::JsonValue& value);

}  // namespace graspfit::sweep
