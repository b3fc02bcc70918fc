#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

namespace graspfit::geometry::internal {

inline constexpr bool kHostIsLittleEndian = std::endian::native == std::endian::little;

/// The number stored in `bytes`, in the stated byte order.
template <typename Number>
Number decoded(const char* bytes, bool is_little_endian) {
  std::array<char, sizeof(Number)> raw;
  std::memcpy(raw.data(), bytes, raw.size());
  if (is_little_endian != kHostIsLittleEndian) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<Number>(raw);
}

template <typename Number>
void append_little_endian(std::string& out, Number value) {
  auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  if (!kHostIsLittleEndian) std::reverse(raw.begin(), raw.end());
  out.append(raw.data(), raw.size());
}

}  // namespace graspfit::geometry::internal
