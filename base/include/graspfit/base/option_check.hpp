#pragma once

#include <concepts>
#include <string>
#include <string_view>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"

namespace graspfit::base {

namespace internal {

template <typename Value>
std::string text_of(const Value& value) {
  if constexpr (std::convertible_to<Value, std::string_view>) {
    return std::string(value);
  } else if constexpr (std::integral<Value>) {
    return std::to_string(value);
  } else {
    return shortest_decimal(value);
  }
}

}  // namespace internal

/// Throws InvalidInput "<where>: <field> = <value>, must be <rule>" unless `is_met`. Write the
/// condition so that NaN does not meet it.
template <typename Value>
void require(bool is_met, std::string_view where, std::string_view field, const Value& value,
             std::string_view rule) {
  if (is_met) return;
  std::string message(where);
  message.append(": ").append(field).append(" = ").append(internal::text_of(value));
  message.append(", must be ").append(rule);
  throw InvalidInput(message);
}

/// Throws as `require` unless a number is in [least, most].
template <typename Value>
void require_between(Value least, Value most, std::string_view where, std::string_view field,
                     Value value) {
  require(value >= least && value <= most, where, field, value,
          "in [" + internal::text_of(least) + ", " + internal::text_of(most) + "]");
}

}  // namespace graspfit::base
