#pragma once

#include <limits>
#include <string>

namespace graspfit::base {

/// The numbers that a setting may have, for checks and for the messages about them.
struct NumberRange {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool has_least = true;  ///< Whether `least` itself is allowed.
  bool has_most = true;   ///< Whether `most` itself is allowed.

  /// Only finite numbers are in any range.
  bool contains(double value) const;

  /// The range as text after "must be": "in [4, 512]", "in (0, 1]", "> 0", ">= 1", "< 90"; "finite"
  /// without bounds.
  std::string text() const;

  /// Returns `value`. @throws InvalidInput "<name> is <value>, must be <range>" if it is outside.
  double checked(const std::string& name, double value) const;
};

constexpr NumberRange at_least(double least) { return {.least = least}; }
constexpr NumberRange above(double least) { return {.least = least, .has_least = false}; }
constexpr NumberRange between(double least, double most) { return {.least = least, .most = most}; }

}  // namespace graspfit::base
