#include "graspfit/base/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace graspfit::base {

std::string shortest_decimal(double value) {
  std::array<char, 32> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

std::string plain_decimal(double value) {
  const double magnitude = std::abs(value);
  if (!(magnitude >= 1e-6 && magnitude < 1e15)) return shortest_decimal(value);
  std::array<char, 64> text{};  // sign, 15 digits, point, 22 decimals
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  return {text.data(), end};
}

}  // namespace graspfit::base
