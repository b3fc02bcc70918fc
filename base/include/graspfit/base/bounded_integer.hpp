#pragma once

#include <concepts>

namespace graspfit::base {

/// `value` without its fraction, as an integer: `least` if it is smaller or NaN, `most` if it is
/// larger. Casting such a double is undefined; on common machines any large one becomes the
/// smallest integer there is.
template <std::signed_integral Integer>
constexpr Integer bounded_integer(double value, Integer least, Integer most) {
  // As a double, `most` may be rounded up, to 2^63; smaller values can be cast.
  if (!(value > static_cast<double>(least))) return least;
  if (value >= static_cast<double>(most)) return most;
  return static_cast<Integer>(value);
}

}  // namespace graspfit::base
