#pragma once

#include <span>
#include <string>
#include <string_view>

namespace graspfit::geometry::internal {

/// Two lower-case digits per byte.
inline std::string hexadecimal(std::span<const unsigned char> bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

}  // namespace graspfit::geometry::internal
