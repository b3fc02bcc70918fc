#pragma once

#include <charconv>
#include <string>

namespace graspfit::hands::internal {

/// A number as text for people, with three significant digits.
inline std::string rounded(double value) {
  char text[32];
  const auto [end, error] =
      std::to_chars(text, text + sizeof text, value, std::chars_format::general, 3);
  return {text, end};
}

}  // namespace graspfit::hands::internal
