#pragma once

#include <string>
#include <vector>

#include "graspfit/base/random.hpp"

namespace graspfit::testing {

/// Returns the text with a few bytes changed, cut out, doubled, or replaced by one of `words`.
inline std::string damaged(std::string text, const std::vector<std::string>& words,
                           base::Random& random) {
  for (std::uint64_t n = 1 + random.index(4); n > 0 && !text.empty(); --n) {
    const std::size_t at = random.index(text.size());
    const std::size_t length = 1 + random.index(12);
    switch (random.index(4)) {
      case 0:
        text[at] = static_cast<char>(random.index(256));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(random.index(text.size()), length));
        break;
      default:
        text.replace(at, length, words[random.index(words.size())]);
    }
  }
  return text;
}

/// Words that readers of URDF and JSON may stumble over.
inline const std::vector<std::string> kWordsForHands = {
    "0",    "-1",   "1e308", "-1e-320", "nan", "inf",   "\n",   "2147483648", "\"",  "<",
    "</a>", "null", "[]",    "{}",      ",",   "&#10;", "left", "base",       "tip", "&lt;",
    "1e",   "",     "\xc3",  "true",    "0x1", "slide", "palm", "-",          "two", "1e200"};

}  // namespace graspfit::testing
