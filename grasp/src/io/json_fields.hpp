#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "graspfit/base/json_value.hpp"
#include "graspfit/grasp/option_names.hpp"
#include "graspfit/grasp/option_row.hpp"
#include "io/record_json.hpp"

/// \file
/// Structs as JSON objects, their fields named once: a function `[](auto& at, auto& s) {...}` names
/// them to a writer or to a reader, in the order of the file.

namespace graspfit::grasp::internal {

/// Puts fields into a JSON object.
class JsonWriter {
 public:
  /// `hand` is asked for the names of its parts; structs that refer to none do not need it.
  explicit JsonWriter(Json& json, const hands::HandModel* hand = nullptr)
      : json_(json), hand_(hand) {}

  template <class Value>
  void operator()(const Value& value, std::string_view key) {
    json_[std::string(key)] = json_of(value);
  }
  template <class Value>
  void operator()(const Value& value, const OptionRow& row) {
    const std::string key(row.key);
    if constexpr (std::is_same_v<Value, double>) {
      open_number(value, key.c_str());
    } else {
      json_[key] = json_of(value);
    }
  }
  void operator()(const std::optional<double>& value, const OptionRow& row) {
    const std::string key(row.key);
    if (row.is_zero_if_empty) {
      open_number(value.value_or(0.0), key.c_str());
    } else {
      json_[key] = json_of(value);
    }
  }
  /// A value that no file is without.
  template <class Value>
  void required(const std::optional<Value>& value, const char* key) {
    json_[key] = json_of(value);
  }
  /// A field that has the same text in every file.
  void constant(std::string_view text, const char* key) { json_[key] = std::string(text); }
  /// JSON has no infinity: it is a text.
  void open_number(double value, const char* key) {
    json_[key] = std::isinf(value) ? Json("infinity") : Json(value);
  }
  void counts(const std::map<std::string, std::int64_t>& counts, const char* key) {
    json_[key] = Json::object();
    for (const auto& [name, count] : counts) json_[key][name] = count;
  }
  void link(int link, const char* key) { json_[key] = hand_->links[link].name; }
  void link(const std::optional<int>& link, const char* key) {
    json_[key] = link ? Json(hand_->links[*link].name) : Json(nullptr);
  }
  void pad(const std::optional<int>& pad, const char* key) {
    json_[key] = hand_->pads[pad.value()].name;
  }
  /// Left out where it is the fingertip's or the palm's.
  void other_pad(const TargetContact& target, const char* key) {
    if (target.pad) pad(target.pad, key);
  }
  void part(const std::optional<int>& finger, const char* key) {
    json_[key] = hand_->part_name(finger);
  }
  /// Null where the target is not assigned.
  void part(const TargetContact& target, const char* key) {
    json_[key] =
        target.is_palm || target.finger ? Json(hand_->part_name(target.finger)) : Json(nullptr);
  }
  /// An empty index is −1.
  void index(const std::optional<int>& index, const char* key) { json_[key] = index.value_or(-1); }

  template <class Struct, class Fields>
  void group(std::string_view key, const Struct& within, const Fields& fields) {
    json_[key] = object_of(within, fields);
  }
  template <class Struct, class Fields>
  void optional_group(std::string_view key, const std::optional<Struct>& within,
                      const Fields& fields) {
    json_[key] = within ? object_of(*within, fields) : Json(nullptr);
  }
  template <class Struct, class Fields>
  void list(const std::vector<Struct>& items, const char* key, const Fields& fields) {
    json_[key] = Json::array();
    for (const Struct& item : items) json_[key].push_back(object_of(item, fields));
  }

 private:
  template <class Struct, class Fields>
  Json object_of(const Struct& within, const Fields& fields) {
    Json json = Json::object();
    JsonWriter writer(json, hand_);
    fields(writer, within);
    return json;
  }
  static Json json_of(const Eigen::Vector3d& value) { return to_json(value); }
  static Json json_of(const std::array<double, 4>& value) { return value; }
  template <class Value>
  static Json json_of(const std::optional<Value>& value) {
    return value ? json_of(*value) : Json(nullptr);
  }
  template <class Value>
  static Json json_of(const Value& value) {
    if constexpr (std::is_enum_v<Value>) {
      return std::string(name_of(value));
    } else {
      return value;
    }
  }

  Json& json_;
  const hands::HandModel* hand_;
};

/// The index of the part of a hand that has this name.
template <class Item>
int index_by_name(const std::vector<Item>& items, const base::JsonValue& name) {
  for (int i = 0; i < std::ssize(items); ++i) {
    if (items[i].name == name.text()) return i;
  }
  name.fail("the hand has nothing named \"" + name.text() + "\"");
}

/// Sets fields from the members of a JSON object. @throws IoError: file, place, what is wrong.
class JsonReader {
 public:
  explicit JsonReader(base::JsonValue node, const hands::HandModel* hand = nullptr)
      : node_(std::move(node)), hand_(hand) {}

  template <class Value>
  void operator()(Value& value, std::string_view key) const {
    read(node_.at(std::string(key)), value);
  }
  template <class Value>
  void operator()(Value& value, const OptionRow& row) const {
    const std::string key(row.key);
    if constexpr (std::is_same_v<Value, double>) {
      open_number(value, key.c_str());
    } else {
      read(node_.at(key), value);
    }
  }
  void operator()(std::optional<double>& value, const OptionRow& row) const {
    const std::string key(row.key);
    if (!row.is_zero_if_empty) {
      read(node_.at(key), value);
    } else {
      open_number(value.emplace(), key.c_str());
      if (*value == 0.0) value.reset();
    }
  }
  template <class Value>
  void required(std::optional<Value>& value, const char* key) const {
    read(node_.at(key), value.emplace());
  }
  void constant(std::string_view text, const char* key) const {
    const base::JsonValue node = node_.at(key);
    if (node.text() != text) node.refuse("must be one of " + std::string(text));
  }
  void open_number(double& value, const char* key) const { read_open(node_.at(key), value); }
  void counts(std::map<std::string, std::int64_t>& counts, const char* key) const {
    for (const auto& [name, count] : node_.at(key).members()) counts[name] = count.integer();
  }
  void link(int& link, const char* key) const { link = index_by_name(hand_->links, node_.at(key)); }
  void link(std::optional<int>& link, const char* key) const {
    if (!node_.at(key).is_null()) link = index_by_name(hand_->links, node_.at(key));
  }
  void pad(std::optional<int>& pad, const char* key) const {
    pad = index_by_name(hand_->pads, node_.at(key));
  }
  void part(std::optional<int>& finger, const char* key) const {
    const base::JsonValue name = node_.at(key);
    if (name.text() != "palm") finger = index_by_name(hand_->fingers, name);
  }
  void part(TargetContact& target, const char* key) const {
    if (node_.at(key).is_null()) return;
    part(target.finger, key);
    target.is_palm = !target.finger;
  }
  void other_pad(TargetContact& target, const char* key) const {
    const std::optional<base::JsonValue> name = node_.find(key);
    if (!name) return;
    target.pad = index_by_name(hand_->pads, *name);
    if (!target.finger || hand_->pads[*target.pad].finger != target.finger) {
      name->fail("pad \"" + name->text() + "\" is not of the target's finger");
    }
    if (target.pad == hand_->fingers[*target.finger].tip_pad) target.pad.reset();
  }
  /// An empty index is −1.
  void index(std::optional<int>& index, const char* key) const {
    const int number = node_.at(key).small_integer();
    if (number >= 0) index = number;
  }

  template <class Struct, class Fields>
  void group(std::string_view key, Struct& within, const Fields& fields) const {
    JsonReader reader(node_.at(std::string(key)), hand_);
    fields(reader, within);
  }
  template <class Struct, class Fields>
  void optional_group(std::string_view key, std::optional<Struct>& within,
                      const Fields& fields) const {
    within.reset();
    if (!node_.at(std::string(key)).is_null()) group(key, within.emplace(), fields);
  }
  template <class Struct, class Fields>
  void list(std::vector<Struct>& items, const char* key, const Fields& fields) const {
    for (const base::JsonValue& item : node_.at(key).items()) {
      JsonReader reader(item, hand_);
      fields(reader, items.emplace_back());
    }
  }

 private:
  static void read_open(const base::JsonValue& node, double& value) {
    const bool is_infinite = node.is_text() && node.text() == "infinity";
    value = is_infinite ? std::numeric_limits<double>::infinity() : node.number();
  }
  static void read(const base::JsonValue& node, double& value) { value = node.number(); }
  static void read(const base::JsonValue& node, int& value) { value = node.small_integer(); }
  static void read(const base::JsonValue& node, std::int64_t& value) { value = node.integer(); }
  static void read(const base::JsonValue& node, std::size_t& value) {
    value = node.unsigned_integer();
  }
  static void read(const base::JsonValue& node, bool& value) { value = node.flag(); }
  static void read(const base::JsonValue& node, std::string& value) { value = node.text(); }
  static void read(const base::JsonValue& node, std::vector<std::string>& value) {
    value = node.texts();
  }
  static void read(const base::JsonValue& node, Eigen::Vector3d& value) { value = vector3(node); }
  static void read(const base::JsonValue& node, std::array<double, 4>& value) {
    value = node.numbers<4>();
  }
  template <class Value>
  static void read(const base::JsonValue& node, std::optional<Value>& value) {
    value.reset();
    if (!node.is_null()) read(node, value.emplace());
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  static void read(const base::JsonValue& node, Enum& value) {
    const std::string name = node.text();
    const auto named = value_named<Enum>(name);
    if (!named) node.refuse("must be one of " + names_of<Enum>());
    value = *named;
  }

  base::JsonValue node_;
  const hands::HandModel* hand_;
};

}  // namespace graspfit::grasp::internal
