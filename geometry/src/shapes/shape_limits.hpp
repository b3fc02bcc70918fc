#pragma once

#include <cmath>
#include <string>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"

/// \file
/// Checks of the numbers that define shapes, with messages in one wording.

namespace graspfit::geometry::internal {

constexpr int kMostSegments = 1 << 14;

inline void require_positive(const std::string& shape, const char* name, double value) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw base::InvalidInput(shape + ": " + name + " is " + base::shortest_decimal(value) +
                             ", must be positive");
  }
}

inline void require_range(const std::string& shape, const char* name, int value, int least,
                          int most) {
  if (value < least || value > most) {
    throw base::InvalidInput(shape + ": " + name + " is " + std::to_string(value) +
                             ", must be in [" + std::to_string(least) + ", " +
                             std::to_string(most) + "]");
  }
}

/// `what` is the bound in the shape's own words: "wall_thickness".
inline void require_below(const std::string& shape, const char* name, double value, double bound,
                          const std::string& what) {
  if (!(value < bound)) {
    throw base::InvalidInput(shape + ": " + name + " is " + base::shortest_decimal(value) +
                             ", must be below " + what + ", " + base::shortest_decimal(bound));
  }
}

inline void require_at_most(const std::string& shape, const char* name, double value, double bound,
                            const std::string& what) {
  if (!(value <= bound)) {
    throw base::InvalidInput(shape + ": " + name + " is " + base::shortest_decimal(value) +
                             ", must be at most " + what + ", " + base::shortest_decimal(bound));
  }
}

}  // namespace graspfit::geometry::internal
