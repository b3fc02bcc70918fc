#pragma once

#include <string>

#include "graspfit/grasp/option_names.hpp"
#include "graspfit/sweep/setting_value.hpp"

namespace graspfit::experiments::internal {

/// The value of an option by its name. @throws SettingError that names those there are.
template <class Enum>
Enum option_value(const sweep::SettingValue& value) {
  const auto chosen = grasp::value_named<Enum>(value.text());
  if (!chosen) value.fail("must be one of " + grasp::names_of<Enum>());
  return *chosen;
}

}  // namespace graspfit::experiments::internal
