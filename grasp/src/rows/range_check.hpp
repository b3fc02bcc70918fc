#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "graspfit/base/option_check.hpp"
#include "rows/option_rows.hpp"

namespace graspfit::grasp::internal {

/// Refuses numbers outside the ranges of their rows; structs within structs check themselves.
class RangeCheck {
 public:
  explicit RangeCheck(std::string_view where) : where_(where) {}

  template <class Value>
  void operator()(const Value& value, const OptionRow& row) const {
    if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>) {
      NumberRange range = row.range;
      range.least = to_field_unit(range.least, row.unit);
      range.most = to_field_unit(range.most, row.unit);
      const auto number = static_cast<double>(value);
      base::require(range.contains(number), where_, row.key, value,
                    (std::isfinite(number) ? "" : "finite and ") + range.text());
    }
  }
  template <class Value>
  void operator()(const std::optional<Value>& value, const OptionRow& row) const {
    if (value) (*this)(*value, row);
  }
  template <class Options, class Rows>
  void group(std::string_view, const Options&, const Rows&) const {}
  template <class Options, class Rows>
  void optional_group(std::string_view, const Options&, const Rows&) const {}

 private:
  std::string_view where_;
};

/// @throws InvalidInput "<where>: <key> = <value>, must be <range>".
template <class Options, class Rows>
void require_ranges(std::string_view where, const Options& options, const Rows& rows) {
  const RangeCheck check(where);
  rows(check, options);
}

}  // namespace graspfit::grasp::internal
