#pragma once

#include <algorithm>
#include <string>

namespace graspfit::sweep::internal {

/// Says whether a label may have this character: letters, digits and _ . + - only, so that labels
/// are names of folders and words of a shell.
inline bool is_label_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '.' || c == '+' || c == '-';
}

/// Says whether a text is a label: it has these characters only, and not dots alone, which name
/// folders, too.
inline bool is_label(const std::string& text) {
  return text.find_first_not_of('.') != std::string::npos &&
         std::all_of(text.begin(), text.end(), is_label_character);
}

}  // namespace graspfit::sweep::internal
