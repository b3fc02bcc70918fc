#include "config/placed_axis.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "config/axis_label.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/json_bounds.hpp"
#include "graspfit/base/json_value.hpp"
#include "graspfit/base/nearest_name.hpp"
#include "graspfit/base/number_text.hpp"

namespace graspfit::sweep::internal {

namespace fs = std::filesystem;
using base::JsonValue;
using SortedJson = nlohmann::json;

namespace {

AxisValue read_axis_value(const std::string& axis, const JsonValue& node) {
  AxisValue value;
  SortedJson settings = SortedJson::object();
  if (node.json().is_object()) {
    value.label = node.at("name").name();
    for (const auto& [key, member] : node.members()) {
      if (key == "note") member.name();
      if (key != "name" && key != "note") settings[key] = SortedJson(member.json());
    }
  } else {
    if (!node.json().is_primitive() || node.json().is_null()) {
      node.fail("is " + node.json().dump() +
                "; a value is a number, a text, true, false, or an object with a name");
    }
    settings[axis] = SortedJson(node.json());
    value.label = plain_label(settings[axis]);
  }
  if (!is_label(value.label)) {
    node.fail("is named \"" + value.label + "\"; names are made of letters, digits and _.+-");
  }
  value.settings = settings.dump();
  return value;
}

/// Keeps the values with these labels, in their old order.
void keep_values(const std::vector<JsonValue>& labels, PlacedAxis& placed) {
  std::set<std::size_t> kept;
  for (const JsonValue& label : labels) {
    const std::string name =
        label.json().is_primitive() ? plain_label(SortedJson(label.json())) : "";
    const std::optional<std::size_t> index = find_value(placed.axis, name);
    if (!index) {
      label.fail("is no value of axis " + placed.axis.name + "; " + labels_text(placed.axis, name));
    }
    kept.insert(*index);
  }
  PlacedAxis remaining;
  remaining.axis.name = placed.axis.name;
  for (const std::size_t index : kept) {
    remaining.axis.values.push_back(placed.axis.values[index]);
    remaining.locations.push_back(placed.locations[index]);
  }
  placed = std::move(remaining);
}

/// {"values_of": SLUG, "only": [labels]}: the values of the axis `name` in the configuration of
/// another experiment in `folder`.
std::vector<AxisValue> values_of(const JsonValue& item, const std::string& name,
                                 const fs::path& folder) {
  item.require_members({"values_of"}, {"only"});
  const JsonValue slug = item.at("values_of");
  if (!is_label(slug.name())) slug.fail("is not the name of an experiment");
  const fs::path file = folder / (slug.name() + ".json");
  std::error_code error;
  if (!fs::is_regular_file(file, error)) slug.fail("has no configuration beside this one");
  const JsonValue root = parsed_config(file.string(), base::read_json_file(file));
  PlacedAxis other;
  other.axis.name = name;
  for (const JsonValue& value : root.at("axes").at(name).some_items()) {
    other.axis.values.push_back(read_axis_value(name, value));
    other.locations.push_back(value.location());
  }
  if (item.has("only")) keep_values(item.at("only").some_items(), other);
  return other.axis.values;
}

}  // namespace

std::string plain_label(const SortedJson& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number_integer()) return value.dump();
  return base::shortest_decimal(value.get<double>());
}

std::string labels_text(const Axis& axis, const std::string& unknown) {
  std::vector<std::string> labels;
  for (const AxisValue& value : axis.values) labels.push_back(value.label);
  return "there are " + base::known_names(unknown, labels);
}

std::optional<std::size_t> find_value(const Axis& axis, const std::string& label) {
  const auto found = std::find_if(axis.values.begin(), axis.values.end(),
                                  [&](const AxisValue& value) { return value.label == label; });
  if (found == axis.values.end()) return std::nullopt;
  return static_cast<std::size_t>(found - axis.values.begin());
}

void pick_values(const JsonValue& picks, PlacedAxis& placed) {
  PlacedAxis own;
  std::vector<JsonValue> labels;
  for (const JsonValue& pick : picks.some_items()) {
    if (!pick.json().is_object()) {
      labels.push_back(pick);
      continue;
    }
    AxisValue value = read_axis_value(placed.axis.name, pick);
    if (find_value(placed.axis, value.label) || find_value(own.axis, value.label)) {
      pick.fail("is the second value named " + value.label);
    }
    own.axis.values.push_back(std::move(value));
    own.locations.push_back(pick.location());
  }
  keep_values(labels, placed);
  std::move(own.axis.values.begin(), own.axis.values.end(), std::back_inserter(placed.axis.values));
  std::move(own.locations.begin(), own.locations.end(), std::back_inserter(placed.locations));
  placed.is_picked = true;
}

base::JsonValue parsed_config(const std::string& file, const std::string& text) {
  return JsonValue::parsed<base::InvalidInput>(text, file);
}

PlacedAxis read_axis(const std::string& name, const JsonValue& node, const fs::path& folder) {
  if (!is_label(name) || name == "seed") {
    node.fail("no axis can be named \"" + name + "\"; \"seeds\" makes the axis seed");
  }
  PlacedAxis placed;
  placed.axis.name = name;
  std::set<std::string> labels;
  for (const JsonValue& item : node.some_items()) {
    std::vector<AxisValue> values;
    if (item.json().is_object() && item.has("values_of")) {
      values = values_of(item, name, folder);
    } else {
      values = {read_axis_value(name, item)};
    }
    for (AxisValue& value : values) {
      if (!labels.insert(value.label).second) {
        item.fail("is the second value named " + value.label);
      }
      placed.axis.values.push_back(std::move(value));
      placed.locations.push_back(item.location());
    }
  }
  return placed;
}

PlacedAxis seed_axis(const JsonValue& node) {
  constexpr std::uint64_t kMostSeeds = 100000;
  const std::uint64_t count = node.unsigned_integer();
  if (count < 1 || count > kMostSeeds) {
    node.fail("is " + std::to_string(count) + ", must be in [1, " + std::to_string(kMostSeeds) +
              "]");
  }
  PlacedAxis placed;
  placed.axis.name = "seed";
  for (std::uint64_t seed = 1; seed <= count; ++seed) {
    placed.axis.values.push_back({std::to_string(seed), "{}"});
    placed.locations.push_back(node.location());
  }
  return placed;
}

}  // namespace graspfit::sweep::internal
