#include "graspfit/base/number_range.hpp"

#include <cmath>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"

namespace graspfit::base {

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

}  // namespace graspfit::base
