#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "graspfit/base/errors.hpp"

namespace graspfit::geometry::internal {

/// The text without the byte order mark that some editors put in front of UTF-8.
inline std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

/// The text in quotes, for a message: printable and cut to `most` characters.
inline std::string in_quotes(std::string_view text, std::size_t most) {
  std::string result = "'";
  for (const char c : text.substr(0, most)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > most ? "...'" : "'");
}

/// Words and numbers of a text, line by line, in the C locale. Errors name the line. A byte order
/// mark in front is skipped.
class TextScanner {
 public:
  explicit TextScanner(std::string_view text) : rest_(without_byte_order_mark(text)) {}

  /// Goes to the next line that is neither empty nor only a comment; false at the end.
  /// `comment` starts a comment that runs to the end of its line; 0 for none.
  bool next_line(char comment = '#') {
    while (!rest_.empty()) {
      const std::size_t end = find_if(rest_, [](char c) { return c == '\n' || c == '\r'; });
      line_ = rest_.substr(0, end);
      if (end == rest_.size()) {
        rest_ = {};
      } else {
        const bool is_pair = rest_.substr(end, 2) == "\r\n";
        rest_.remove_prefix(end + (is_pair ? 2 : 1));
      }
      ++line_number_;
      if (comment != 0) {
        line_ = line_.substr(0, find_if(line_, [=](char c) { return c == comment; }));
      }
      skip_spaces();
      if (!line_.empty()) return true;
    }
    line_ = {};
    return false;
  }

  bool line_is_empty() const { return line_.empty(); }
  int line_number() const { return line_number_; }

  /// What follows the current line.
  std::string_view rest() const { return rest_; }

  /// The next word of the line; empty at its end.
  std::string_view word() {
    const std::string_view result = line_.substr(0, find_if(line_, is_space));
    line_.remove_prefix(result.size());
    skip_spaces();
    return result;
  }

  /// A coordinate of the line: any finite number.
  double coordinate() {
    const std::string_view text = word();
    double value = 0.0;
    if (!parse(text, value)) fail("expected a number, found " + quoted(text));
    if (!std::isfinite(value)) fail("coordinate " + std::string(text) + " is not finite");
    return value;
  }

  std::int64_t integer(const char* what) {
    const std::string_view text = word();
    std::int64_t value = 0;
    if (!parse(text, value)) {
      fail(std::string("expected ") + what + ", found " + quoted(text));
    }
    return value;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw base::IoError("line " + std::to_string(line_number_) + ": " + what);
  }

  /// The whole of `text` as a number. Too large ones become infinite, too small ones zero.
  static bool parse(std::string_view text, double& value) {
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    const char* const end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    if (result.ptr != end || text.empty()) return false;
    if (result.ec == std::errc::result_out_of_range) {
      value = std::strtod(std::string(text).c_str(), nullptr);
      return true;
    }
    return result.ec == std::errc();
  }
  static bool parse(std::string_view text, std::int64_t& value) {
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    const char* const end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    return result.ec == std::errc() && result.ptr == end && !text.empty();
  }

  /// A word for a message.
  static std::string quoted(std::string_view text) {
    return text.empty() ? "the end of the line" : in_quotes(text, 24);
  }

 private:
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

  // Index of the first character for which `is_it` holds, or the size of `text`. Lines and words
  // are short: `find_first_of`, which calls memchr for every character, took more than half of the
  // time of reading.
  template <typename Predicate>
  static std::size_t find_if(std::string_view text, Predicate is_it) {
    return static_cast<std::size_t>(std::find_if(text.begin(), text.end(), is_it) - text.begin());
  }

  void skip_spaces() {
    line_.remove_prefix(find_if(line_, [](char c) { return !is_space(c); }));
  }

  std::string_view rest_;
  std::string_view line_;
  int line_number_ = 0;
};

}  // namespace graspfit::geometry::internal
