#include "io/json_text.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <nlohmann/json.hpp>

#include "graspfit/base/number_text.hpp"

namespace graspfit::grasp::internal {
namespace {

using nlohmann::ordered_json;

void append(const ordered_json& json, int depth, std::string& text) {
  const auto new_line = [&text](int indent) {
    text += '\n';
    text.append(2 * static_cast<std::size_t>(indent), ' ');
  };
  if (json.is_object() && !json.empty()) {
    text += '{';
    const char* separator = "";
    for (const auto& [key, value] : json.items()) {
      text += separator;
      separator = ",";
      new_line(depth + 1);
      text += ordered_json(key).dump() + ": ";
      append(value, depth + 1, text);
    }
    new_line(depth);
    text += '}';
  } else if (json.is_array() && !json.empty()) {
    const bool is_flat = std::none_of(
        json.begin(), json.end(), [](const ordered_json& item) { return item.is_structured(); });
    text += '[';
    const char* separator = "";
    for (const ordered_json& item : json) {
      text += separator;
      separator = is_flat ? ", " : ",";
      if (!is_flat) new_line(depth + 1);
      append(item, depth + 1, text);
    }
    if (!is_flat) new_line(depth);
    text += ']';
  } else if (json.is_number_float()) {
    assert(std::isfinite(json.get<double>()));
    text += base::shortest_decimal(json.get<double>());
  } else {
    // Bytes that are not UTF-8 become replacement characters instead of an exception; paths are
    // given by their `path_text`, so that they come back.
    text += json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  }
}

}  // namespace

std::string json_text(const ordered_json& json) {
  std::string text;
  append(json, 0, text);
  text += '\n';
  return text;
}

}  // namespace graspfit::grasp::internal
