#pragma once

#include <concepts>
#include <string>
#include <string_view>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"

namespace graspfit::base {

/// Throws InvalidInput "<where>: <field> = <value>, must be <rule>" unless `is_met`. Write the
/// condition so that NaN does not meet it.
template <typename Value>
void require(bool is_met, std::string_view where, std::string_view field, const Value& value,
             std::string_view rule) {
  if (is_met) return;
  std::string message(where);
  message.append(": ").append(field).append(" = ");
  if constexpr (std::convertible_to<Value, std::string_view>) {
    message.append(value);
  } else if constexpr (std::integral<Value>) {
    message.append(std::to_string(value));
  } else {
    message.append(shortest_decimal(value));
  }
  message.append(", must be ").append(rule);
  throw InvalidInput(message);
}

}  // namespace graspfit::base
