#pragma once

namespace graspfit::hands::internal {

/// Whether a byte is a control character of ASCII. Names with one would break messages of one line.
constexpr bool is_control(char c) { return static_cast<unsigned char>(c) < ' '; }

}  // namespace graspfit::hands::internal
