#include "graspfit/base/json_value.hpp"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/json_bounds.hpp"
#include "graspfit/base/nearest_name.hpp"
#include "graspfit/base/path_text.hpp"

namespace graspfit::base {

struct JsonValue::Document {
  Json root;
  Fault fault;
};

namespace {

constexpr std::size_t kLongestShown = 60;  // Of a value in a message; a line is read at a glance.

std::string shown(const JsonValue::Json& json) {
  std::string text = json.dump();
  if (text.size() <= kLongestShown) return text;
  std::size_t end = kLongestShown;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + "...";
}

/// Replaces line breaks, which keys of a file may hold.
std::string in_one_line(std::string text) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' '; };
  std::replace_if(text.begin(), text.end(), is_control, ' ');
  return text;
}

}  // namespace

JsonValue::JsonValue(const Json& root, Fault fault, std::string location)
    : document_(std::make_shared<const Document>(Document{root, std::move(fault)})),
      json_(&document_->root),
      location_(std::move(location)) {}

JsonValue JsonValue::parsed(const std::string& text, const std::string& file,
                            void (*raise)(const std::string& message)) {
  require_bounded_json(text, file, kMostOrderedMembers);
  auto document = std::make_shared<Document>();
  try {
    document->root = Json::parse(text);
  } catch (const Json::exception& error) {
    throw IoError(file + ": is not JSON: " + json_fault(error.what()));
  }
  document->fault = [file, raise](const std::string& location, const std::string& what) {
    raise(in_one_line(file) + ": " + (location.empty() ? "/" : location) + ": " + what);
  };
  return {document, &document->root, ""};
}

JsonValue JsonValue::with_root(const Json& root) const { return {root, document_->fault}; }

JsonValue JsonValue::child(const Json& json, const std::string& name) const {
  return {document_, &json, location_ + '/' + name};
}

void JsonValue::fail(const std::string& what) const {
  document_->fault(in_one_line(location_), in_one_line(what));
  throw std::logic_error("a fault of JSON was not thrown");
}

void JsonValue::refuse(const std::string& rule) const { fail("is " + shown(*json_) + ", " + rule); }

void JsonValue::refuse_count(std::size_t given, std::size_t wanted) const {
  fail("has " + std::to_string(given) + " of " + std::to_string(wanted) + " numbers");
}

bool JsonValue::is_null() const { return json_->is_null(); }
bool JsonValue::is_text() const { return json_->is_string(); }
bool JsonValue::has(const std::string& key) const { return json_->contains(key); }

JsonValue JsonValue::at(const std::string& key) const {
  if (!json_->is_object()) refuse("must be an object");
  const auto member = json_->find(key);
  if (member == json_->end()) child(*json_, key).fail("is missing");
  return child(*member, key);
}

std::optional<JsonValue> JsonValue::find(const std::string& key) const {
  if (!json_->is_object()) refuse("must be an object");
  const auto member = json_->find(key);
  if (member == json_->end() || member->is_null()) return std::nullopt;
  return child(*member, key);
}

std::vector<std::pair<std::string, JsonValue>> JsonValue::members() const {
  if (!json_->is_object()) refuse("must be an object");
  std::vector<std::pair<std::string, JsonValue>> values;
  for (const auto& [key, value] : json_->items()) values.emplace_back(key, child(value, key));
  return values;
}

void JsonValue::require_members(const std::vector<std::string>& required,
                                const std::vector<std::string>& optional) const {
  std::vector<std::string> known = required;
  known.insert(known.end(), optional.begin(), optional.end());
  for (const auto& [key, value] : members()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    value.fail("is not a member that is known here; there are " + known_names(key, known));
  }
  for (const std::string& key : required) at(key);
}

std::vector<JsonValue> JsonValue::items() const {
  if (!json_->is_array()) refuse("must be an array");
  std::vector<JsonValue> values;
  for (const Json& item : *json_) values.push_back(child(item, std::to_string(values.size())));
  return values;
}

std::vector<JsonValue> JsonValue::some_items() const {
  if (!json_->is_array() || json_->empty()) refuse("must be an array with at least one value");
  return items();
}

double JsonValue::number() const {
  if (!json_->is_number()) refuse("must be a number");
  return json_->get<double>();
}

double JsonValue::positive_number() const {
  if (!(number() > 0.0)) refuse("must be > 0");
  return number();
}

std::int64_t JsonValue::integer() const {
  constexpr std::uint64_t kMost = std::numeric_limits<std::int64_t>::max();
  if (!json_->is_number_integer()) refuse("must be an integer");
  if (json_->is_number_unsigned() && json_->get<std::uint64_t>() > kMost) {
    refuse("must be an integer of 64 bits");
  }
  return json_->get<std::int64_t>();
}

std::uint64_t JsonValue::unsigned_integer() const {
  if (!json_->is_number_unsigned()) refuse("must be an integer from 0");
  return json_->get<std::uint64_t>();
}

int JsonValue::small_integer() const {
  using Limits = std::numeric_limits<int>;
  const std::int64_t value = integer();
  if (value < Limits::min() || value > Limits::max()) refuse("must be an integer of 32 bits");
  return static_cast<int>(value);
}

bool JsonValue::flag() const {
  if (!json_->is_boolean()) refuse("must be true or false");
  return json_->get<bool>();
}

std::string JsonValue::text() const {
  if (!json_->is_string()) refuse("must be a text");
  return json_->get<std::string>();
}

std::string JsonValue::name() const {
  if (!json_->is_string() || text().empty()) refuse("must be a text that is not empty");
  return text();
}

std::string JsonValue::path() const { return path_of_text(text()); }

std::vector<std::string> JsonValue::texts() const {
  std::vector<std::string> texts;
  for (const JsonValue& item : items()) texts.push_back(item.text());
  return texts;
}

}  // namespace graspfit::base
