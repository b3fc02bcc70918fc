#include "graspfit/geometry/number_range.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"

namespace graspfit::geometry {

std::string plain_decimal(double value) {
  const double magnitude = std::abs(value);
  if (!(magnitude >= 1e-6 && magnitude < 1e15)) return shortest_decimal(value);
  std::array<char, 64> text{};  // sign, 15 digits, point, 22 decimals
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  return {text.data(), end};
}

bool NumberRange::contains(double value) const {
  return std::isfinite(value) && (has_least ? value >= least : value > least) &&
         (has_most ? value <= most : value < most);
}

std::string NumberRange::text() const {
  const bool is_bounded_below = std::isfinite(least);
  const bool is_bounded_above = std::isfinite(most);
  if (is_bounded_below && is_bounded_above) {
    return std::string("in ") + (has_least ? '[' : '(') + plain_decimal(least) + ", " +
           plain_decimal(most) + (has_most ? ']' : ')');
  }
  if (is_bounded_below) return (has_least ? ">= " : "> ") + plain_decimal(least);
  if (is_bounded_above) return (has_most ? "<= " : "< ") + plain_decimal(most);
  return "finite";
}

double NumberRange::checked(const std::string& name, double value) const {
  if (contains(value)) return value;
  throw InvalidInput(name + " is " + plain_decimal(value) + ", must be " + text());
}

}  // namespace graspfit::geometry
