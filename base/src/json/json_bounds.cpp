#include "graspfit/base/json_bounds.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <system_error>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"

namespace graspfit::base {

namespace {

void require_bounded_size(std::uintmax_t size, const std::string& name) {
  if (size <= kLargestJson) return;
  throw IoError(name + ": has " + std::to_string(size) + " bytes; JSON is read up to " +
                std::to_string(kLargestJson) + " bytes");
}

/// A position as text, "line 3, column 70"; both numbers count from 1.
std::string place_text(std::string_view text, std::size_t at) {
  const std::string_view before = text.substr(0, at);
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const std::size_t line_break = before.rfind('\n');
  const std::size_t column = line_break == std::string_view::npos ? at + 1 : at - line_break;
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

/// Index of the end of the string that begins at `at`: its closing quote, or the end of the text.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  for (++at; at < text.size() && text[at] != '"'; ++at) {
    if (text[at] == '\\') ++at;  // whatever is escaped, a quote too
  }
  return at;
}

}  // namespace

void require_bounded_json(std::string_view text, const std::string& name,
                          std::size_t most_members) {
  require_bounded_size(text.size(), name);
  const auto refuse = [&](std::size_t at, const std::string& what) {
    throw IoError(name + ": " + place_text(text, at) + ": " + what);
  };
  std::array<std::size_t, kDeepestJson + 1> num_members{};  // of each open object, by depth
  int depth = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"') {
      at = end_of_string(text, at);
    } else if (c == '[' || c == '{') {
      if (++depth > kDeepestJson) {
        refuse(at, "nests deeper than " + std::to_string(kDeepestJson) +
                       " levels, which is as deep as JSON is read");
      }
      num_members[depth] = 0;
    } else if (c == ':' && depth > 0 && ++num_members[depth] > most_members) {
      refuse(at, "an object has more than " + std::to_string(most_members) +
                     " members, which is as many as are read");
    } else if (c == ']' || c == '}') {
      --depth;  // below zero, the text is no JSON, and the parser stops there
    }
  }
}

std::string read_json_file(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error) require_bounded_size(size, file.string());
  std::string text = read_file(file);
  require_bounded_json(text, file.string());
  return text;
}

std::string json_fault(const std::string& what) {
  const std::size_t end = what.find("] ");
  return end == std::string::npos ? what : what.substr(end + 2);
}

}  // namespace graspfit::base
