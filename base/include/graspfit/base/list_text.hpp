#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace graspfit::base {

/// The texts of some items one after the other, "a, b, c". `text` is a function or a member that
/// gives the text of an item; without it the items are texts.
template <class Items, class Text = std::identity>
std::string list_text(const Items& items, const Text& text = {},
                      std::string_view separator = ", ") {
  std::string list;
  for (const auto& item : items) {
    if (!list.empty()) list += separator;
    list += std::invoke(text, item);
  }
  return list;
}

}  // namespace graspfit::base
