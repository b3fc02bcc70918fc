#pragma once

#include <charconv>
#include <string>
#include <vector>

namespace graspfit::hands::internal {

/// For people: three digits.
inline std::string rounded(double value) {
  char text[32];
  const auto [end, error] =
      std::to_chars(text, text + sizeof text, value, std::chars_format::general, 3);
  return {text, end};
}

/// "a, b, c".
inline std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace graspfit::hands::internal
