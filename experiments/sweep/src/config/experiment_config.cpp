#include "graspfit/sweep/experiment_config.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "config/axis_label.hpp"
#include "config/object_axis.hpp"
#include "config/placed_axis.hpp"
#include "graspfit/base/json_bounds.hpp"
#include "graspfit/base/json_value.hpp"
#include "graspfit/base/list_text.hpp"
#include "graspfit/base/nearest_name.hpp"
#include "graspfit/base/sha256.hpp"
#include "graspfit/sweep/data_needs.hpp"

namespace graspfit::sweep {
namespace {

namespace fs = std::filesystem;
using base::JsonValue;
using internal::find_value;
using internal::is_label;
using internal::labels_text;
using internal::PlacedAxis;
using internal::plain_label;
using SortedJson = nlohmann::json;

constexpr std::size_t kMostCells = 1000000;  // A sweep beyond that is a mistake in its axes.

/// Settings that say what an object is. An object has one of them, so that naming one removes the
/// others.
constexpr std::array kObjectSources = {"file", "packaged", "shape"};

/// The configuration while it is put together.
struct Draft {
  std::string file;
  SortedJson settings = SortedJson::object();
  std::map<std::string, std::string> setting_locations;
  std::vector<PlacedAxis> axes;
};

void read_settings(const JsonValue& node, Draft& draft) {
  for (const auto& [key, value] : node.members()) {
    draft.settings[key] = SortedJson(value.json());
    draft.setting_locations[key] = value.location();
  }
}

/// Removes what the settings of all cells say of the object, if `key` is a setting that says it,
/// too.
void forget_other_objects(const std::string& key, Draft& draft) {
  if (std::find(kObjectSources.begin(), kObjectSources.end(), key) == kObjectSources.end()) return;
  for (const char* const source : kObjectSources) draft.settings.erase(source);
}

PlacedAxis* find_axis(Draft& draft, const std::string& name) {
  const auto found = std::find_if(draft.axes.begin(), draft.axes.end(),
                                  [&](const PlacedAxis& axis) { return axis.axis.name == name; });
  return found == draft.axes.end() ? nullptr : &*found;
}

void apply_quick(const JsonValue& quick, Draft& draft) {
  quick.require_members({}, {"axes", "settings", "seeds"});
  if (quick.has("seeds")) {
    PlacedAxis* const seeds = find_axis(draft, "seed");
    if (seeds == nullptr) quick.at("seeds").fail("there are no \"seeds\" to have fewer of");
    *seeds = internal::seed_axis(quick.at("seeds"));
  }
  if (quick.has("settings")) {
    for (const auto& [key, value] : quick.at("settings").members()) {
      forget_other_objects(key, draft);
    }
    read_settings(quick.at("settings"), draft);
  }
  if (!quick.has("axes")) return;
  for (const auto& [name, labels] : quick.at("axes").members()) {
    PlacedAxis* const placed = find_axis(draft, name);
    if (placed == nullptr) {
      std::vector<std::string> names;
      for (const PlacedAxis& axis : draft.axes) names.push_back(axis.axis.name);
      labels.fail("there is no axis of that name" + base::did_you_mean(name, names));
    }
    internal::pick_values(labels, *placed);
  }
}

/// A value of the command line: a number, true or false as in JSON, else a text.
SortedJson parsed_value(const std::string& text) {
  SortedJson value = SortedJson::parse(text, nullptr, false);
  if (value.is_discarded() || !value.is_primitive() || value.is_null()) value = text;
  return value;
}

/// Values of the command line for an axis of plain values, a setting, or the seeds.
AxisValue changed_value(const AxisChange& change, const std::string& text) {
  AxisValue value;
  value.label = text;
  if (change.axis == "seed") {
    const SortedJson seed = parsed_value(text);
    if (!seed.is_number_unsigned()) {
      throw base::InvalidInput("--set seed: \"" + text + "\" is not an integer from 0");
    }
    value.settings = "{}";
  } else {
    const SortedJson parsed = parsed_value(text);
    value.label = plain_label(parsed);
    value.settings = SortedJson{{change.axis, parsed}}.dump();
  }
  if (!is_label(value.label)) {
    throw base::InvalidInput("--set " + change.axis + ": \"" + text +
                             "\" is made of more than letters, digits and _.+-");
  }
  return value;
}

/// Says whether all values of an axis set only the setting that the axis is named after, as plain
/// values do.
bool has_plain_values(const Axis& axis) {
  return std::all_of(axis.values.begin(), axis.values.end(), [&](const AxisValue& value) {
    const SortedJson settings = SortedJson::parse(value.settings);
    return axis.name == "seed" || (settings.size() == 1 && settings.contains(axis.name));
  });
}

/// Refuses a name that is near to that of an axis or setting, but is neither. The experiment itself
/// refuses what is near to nothing.
void refuse_mistyped(const Experiment& experiment, const AxisChange& change, const Draft& draft) {
  std::vector<std::string> known = {"seed"};
  for (const PlacedAxis& placed : draft.axes) known.push_back(placed.axis.name);
  for (const auto* const settings : {&experiment.settings, &experiment.shared_settings}) {
    for (const Column& setting : *settings) known.push_back(setting.name);
  }
  if (std::find(known.begin(), known.end(), change.axis) != known.end()) return;
  const std::string meant = base::did_you_mean(change.axis, known);
  if (meant.empty()) return;
  throw base::InvalidInput("--set " + change.axis + ": " + experiment.slug +
                           " has no axis or setting of that name" + meant);
}

void apply_change(const AxisChange& change, Draft& draft) {
  PlacedAxis changed;
  changed.axis.name = change.axis;
  changed.is_picked = true;
  const PlacedAxis* const old = find_axis(draft, change.axis);
  std::set<std::string> labels;
  for (const std::string& text : change.values) {
    const auto index = old == nullptr ? std::nullopt : find_value(old->axis, text);
    if (index) {
      changed.axis.values.push_back(old->axis.values[*index]);
    } else if (old == nullptr || has_plain_values(old->axis)) {
      changed.axis.values.push_back(changed_value(change, text));
    } else {
      throw base::InvalidInput("--set " + change.axis + ": \"" + text +
                               "\" is no value of that axis; " + labels_text(old->axis, text));
    }
    changed.locations.push_back("--set " + change.axis);
    if (!labels.insert(changed.axis.values.back().label).second) {
      throw base::InvalidInput("--set " + change.axis + ": \"" + text + "\" is given twice");
    }
  }
  if (PlacedAxis* const placed = find_axis(draft, change.axis)) {
    *placed = std::move(changed);
    return;
  }
  draft.settings.erase(change.axis);
  forget_other_objects(change.axis, draft);
  // Seeds stay last.
  const auto seeds = std::find_if(draft.axes.begin(), draft.axes.end(),
                                  [](const PlacedAxis& axis) { return axis.axis.name == "seed"; });
  draft.axes.insert(change.axis == "seed" ? draft.axes.end() : seeds, std::move(changed));
}

/// Returns the axis, other than that of objects, that sets the objects' sizes; null if none does.
const PlacedAxis* size_axis_of(const Draft& draft) {
  const auto sets_size = [](const AxisValue& value) {
    return SortedJson::parse(value.settings).contains("size_m");
  };
  const auto found =
      std::find_if(draft.axes.begin(), draft.axes.end(), [&](const PlacedAxis& placed) {
        const std::vector<AxisValue>& values = placed.axis.values;
        return placed.axis.name != kObjectAxis &&
               std::any_of(values.begin(), values.end(), sets_size);
      });
  return found == draft.axes.end() ? nullptr : &*found;
}

bool lacks_data(const AxisValue& value) { return !has_all_data(value.settings); }

/// Adds objects that every machine has where the axis of objects lacks some.
void add_default_objects(Draft& draft) {
  PlacedAxis* const placed = find_axis(draft, kObjectAxis);
  if (placed == nullptr || placed->is_picked) return;
  std::vector<AxisValue>& values = placed->axis.values;
  if (std::none_of(values.begin(), values.end(), lacks_data)) return;
  const bool has_sizes = size_axis_of(draft) != nullptr || draft.settings.contains("size_m");
  for (AxisValue& object : internal::default_objects(has_sizes)) {
    if (find_value(placed->axis, object.label)) continue;
    values.push_back(std::move(object));
    placed->locations.push_back("default objects");
  }
}

/// Leaves out values that lack data, where other values remain and nobody asked for them. Returns
/// which axes have changed, for people; `num_values` is how many values they had.
std::string leave_out_missing_data(Draft& draft,
                                   const std::map<std::string, std::size_t>& num_values) {
  std::string text;
  for (PlacedAxis& placed : draft.axes) {
    const std::vector<AxisValue>& values = placed.axis.values;
    const auto num_lacking =
        static_cast<std::size_t>(std::count_if(values.begin(), values.end(), lacks_data));
    if (placed.is_picked || num_lacking == 0 || num_lacking == values.size()) continue;
    PlacedAxis remaining;
    remaining.axis.name = placed.axis.name;
    std::string labels;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (lacks_data(values[i])) continue;
      labels += (labels.empty() ? "" : ", ") + values[i].label;
      remaining.axis.values.push_back(values[i]);
      remaining.locations.push_back(placed.locations[i]);
    }
    placed = std::move(remaining);
    text += (text.empty() ? "" : "; ") + placed.axis.name + " is " + labels + ", without " +
            std::to_string(num_lacking) + " of " + std::to_string(num_values.at(placed.axis.name));
  }
  return text;
}

/// Meshes of the command line on the axis of objects: instead of its values, or beside those that
/// a change has picked.
void apply_object_files(const Experiment& experiment, const ConfigRequest& request, Draft& draft) {
  PlacedAxis* const placed = find_axis(draft, kObjectAxis);
  if (placed == nullptr) {
    throw base::InvalidInput(
        "--object: " + experiment.slug + " has no axis " + kObjectAxis + "; there are " +
        base::list_text(draft.axes, [](auto& other) { return other.axis.name; }));
  }
  if (const PlacedAxis* const sizes = size_axis_of(draft);
      sizes != nullptr && request.object_longest) {
    throw base::InvalidInput("--longest: axis " + sizes->axis.name + " of " + experiment.slug +
                             " sets the objects' sizes; pick some with --set " + sizes->axis.name +
                             "=...");
  }
  const bool is_picked =
      std::any_of(request.changes.begin(), request.changes.end(),
                  [](const AxisChange& change) { return change.axis == kObjectAxis; });
  if (!is_picked) *placed = PlacedAxis{{kObjectAxis, {}}, {}, false};
  placed->is_picked = true;
  for (AxisValue& value : internal::object_file_values(request.object_files, request.object_longest,
                                                       placed->axis.values)) {
    placed->axis.values.push_back(std::move(value));
    placed->locations.push_back("--object");
  }
}

/// Requires that each setting belongs to one axis: if two axes set it, one would hide the other.
void require_separate_axes(const Draft& draft) {
  std::map<std::string, std::string> owners;
  for (const PlacedAxis& placed : draft.axes) {
    std::set<std::string> keys;
    for (const AxisValue& value : placed.axis.values) {
      const SortedJson settings = SortedJson::parse(value.settings);
      for (const auto& [key, setting] : settings.items()) keys.insert(key);
    }
    for (const std::string& key : keys) {
      const auto [owner, is_new] = owners.emplace(key, placed.axis.name);
      if (!is_new) {
        throw base::InvalidInput(draft.file + ": setting " + key + " is set by axis " +
                                 owner->second + " and by axis " + placed.axis.name);
      }
    }
  }
}

/// Where a setting of a cell was written.
std::string location_of(const Draft& draft, const Cell& cell, const std::string& key) {
  for (std::size_t i = 0; i < draft.axes.size(); ++i) {
    const Axis& axis = draft.axes[i].axis;
    const std::size_t index = find_value(axis, cell.labels[i]).value();
    if (!SortedJson::parse(axis.values[index].settings).contains(key)) continue;
    const std::string& location = draft.axes[i].locations[index];
    return key == axis.name ? location : location + '/' + key;
  }
  const auto found = draft.setting_locations.find(key);
  if (found != draft.setting_locations.end()) return found->second;
  return "cell " + cell.key + (key.empty() ? "" : ": " + key);
}

void check_cells(const Experiment& experiment, const Draft& draft, const ParameterSweep& sweep) {
  for (std::size_t i = 0; i < sweep.num_cells(); ++i) {
    const Cell cell = sweep.cell(i);
    try {
      experiment.check(cell);
    } catch (const SettingError& error) {
      const std::string& key = error.key();
      throw base::InvalidInput(draft.file + ": " + location_of(draft, cell, key) + ": " +
                               error.what());
    } catch (const base::InvalidInput& error) {
      throw base::InvalidInput(draft.file + ": cell " + cell.key + ": " + error.what());
    }
  }
}

ParameterSweep sweep_of(const Draft& draft, const std::string& slug, std::uint64_t seed) {
  ParameterSweep sweep;
  sweep.experiment = slug;
  sweep.base_seed = seed;
  sweep.settings = draft.settings.dump();
  std::size_t count = 1;
  for (const PlacedAxis& placed : draft.axes) {
    sweep.axes.push_back(placed.axis);
    if (placed.axis.values.size() > kMostCells / count) {
      throw base::InvalidInput(draft.file + ": more than " + std::to_string(kMostCells) + " cells");
    }
    count *= placed.axis.values.size();
  }
  return sweep;
}

}  // namespace

AxisChange parse_axis_change(const std::string& text) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos || sign == 0 || sign + 1 == text.size()) {
    throw base::InvalidInput("--set \"" + text + "\" is not AXIS=A,B,...");
  }
  AxisChange change{text.substr(0, sign), {}};
  for (std::size_t begin = sign + 1; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    if (end == begin) throw base::InvalidInput("--set \"" + text + "\" has an empty value");
    change.values.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  if (text.back() == ',') throw base::InvalidInput("--set \"" + text + "\" has an empty value");
  return change;
}

std::string ExperimentConfig::identity() const {
  SortedJson axes = SortedJson::array();
  for (const Axis& axis : sweep.axes) {
    SortedJson values = SortedJson::array();
    for (const AxisValue& value : axis.values) {
      values.push_back({{"label", value.label}, {"settings", SortedJson::parse(value.settings)}});
    }
    axes.push_back({{"name", axis.name}, {"values", values}});
  }
  const SortedJson identity = {{"experiment", sweep.experiment},
                               {"seed", sweep.base_seed},
                               {"settings", SortedJson::parse(sweep.settings)},
                               {"axes", axes}};
  return identity.dump();
}

ExperimentConfig read_config(const Experiment& experiment, const fs::path& file,
                             const ConfigRequest& request) {
  ExperimentConfig config;
  config.file = file.string();
  const std::string text = base::read_json_file(file);
  config.sha256 = base::sha256_hex(text);
  const JsonValue root = internal::parsed_config(config.file, text);
  root.require_members({"experiment", "question", "cell", "seed", "axes"},
                       {"seeds", "settings", "quick"});
  if (root.at("experiment").name() != experiment.slug) {
    root.at("experiment").fail("is not " + experiment.slug);
  }
  config.question = root.at("question").name();
  config.cell = root.at("cell").name();

  Draft draft;
  draft.file = config.file;
  if (root.has("settings")) read_settings(root.at("settings"), draft);
  for (const auto& [name, values] : root.at("axes").members()) {
    draft.axes.push_back(internal::read_axis(name, values, file.parent_path()));
  }
  if (draft.axes.empty()) root.at("axes").fail("is empty; a sweep has at least one axis");
  if (root.has("seeds")) draft.axes.push_back(internal::seed_axis(root.at("seeds")));
  if (request.is_quick) {
    if (!root.has("quick")) root.at("quick");
    apply_quick(root.at("quick"), draft);
  }
  std::map<std::string, std::size_t> num_values;
  for (const PlacedAxis& placed : draft.axes) {
    num_values[placed.axis.name] = placed.axis.values.size();
  }
  if (request.leaves_out_missing_data) add_default_objects(draft);
  for (const AxisChange& change : request.changes) {
    refuse_mistyped(experiment, change, draft);
    apply_change(change, draft);
  }
  if (!request.object_files.empty()) apply_object_files(experiment, request, draft);
  if (request.leaves_out_missing_data) {
    config.left_out = leave_out_missing_data(draft, num_values);
  }
  require_separate_axes(draft);

  config.is_quick = request.is_quick;
  config.is_modified =
      !request.changes.empty() || !request.object_files.empty() || !config.left_out.empty();
  config.sweep = sweep_of(draft, experiment.slug, root.at("seed").unsigned_integer());
  check_cells(experiment, draft, config.sweep);
  return config;
}

}  // namespace graspfit::sweep
