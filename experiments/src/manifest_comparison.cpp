#include <nlohmann/json.hpp>
#include <system_error>

#include "graspfit/experiments/table_comparison.hpp"
#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"

namespace graspfit::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

Json read_manifest(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return {};
  Json json = Json::parse(geometry::read_file(file), nullptr, false);
  if (!json.is_object()) throw geometry::InvalidInput(file.string() + ": is damaged");
  return json;
}

/// A member as an object; empty if there is none.
Json object_at(const Json& json, const char* pointer) {
  const Json::json_pointer place(pointer);
  return json.contains(place) && json.at(place).is_object() ? json.at(place) : Json::object();
}

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

/// Differences of settings as "name theirs, here ours".
class Differences {
 public:
  void compare(const std::string& name, const Json* ours, const Json* theirs) {
    if (ours != nullptr && theirs != nullptr && *ours == *theirs) return;
    text_ += (text_.empty() ? "" : "; ") + name + ' ' + value(theirs) + ", here " + value(ours);
  }

  /// All members that one of two objects has.
  void compare_members(const std::string& prefix, const Json& ours, const Json& theirs) {
    Json all = ours;
    all.update(theirs);
    for (const auto& [name, value] : all.items()) {
      compare(prefix + name, find(ours, name), find(theirs, name));
    }
  }

  const std::string& text() const { return text_; }

 private:
  static const Json* find(const Json& object, const std::string& name) {
    const auto found = object.find(name);
    return found == object.end() ? nullptr : &*found;
  }
  static std::string value(const Json* value) { return value ? text_of(*value) : "not given"; }

  std::string text_;
};

/// Label -> settings of each axis's values, by the axis's name.
Json values_by_label(const Json& as_run) {
  Json axes = Json::object();
  if (!as_run.contains("axes")) return axes;
  for (const Json& axis : as_run.at("axes")) {
    Json& values = axes[axis.at("name").get<std::string>()] = Json::object();
    for (const Json& value : axis.at("values")) {
      values[value.at("label").get<std::string>()] = value.at("settings");
    }
  }
  return axes;
}

std::string other_settings(const Json& ours, const Json& theirs) {
  Differences differences;
  const auto seed_of = [](const Json& as_run) {
    return as_run.contains("seed") ? as_run.at("seed") : Json();
  };
  const Json our_seed = seed_of(ours);
  const Json their_seed = seed_of(theirs);
  differences.compare("seed", &our_seed, &their_seed);
  differences.compare_members("", object_at(ours, "/settings"), object_at(theirs, "/settings"));
  const Json our_axes = values_by_label(ours);
  const Json their_axes = values_by_label(theirs);
  for (const auto& [axis, values] : our_axes.items()) {
    if (!their_axes.contains(axis)) continue;
    for (const auto& [label, settings] : values.items()) {
      if (!their_axes.at(axis).contains(label)) continue;
      differences.compare_members(axis + '=' + label + ' ', settings,
                                  their_axes.at(axis).at(label));
    }
  }
  return differences.text();
}

/// "commit a7a0195", "commit a7a0195 with changes", "unknown".
std::string code_text(const Json& manifest) {
  constexpr std::size_t kShort = 7;
  const std::string commit = manifest.value("commit", "");
  if (commit.empty()) return "unknown";
  return "commit " + commit.substr(0, kShort) +
         (manifest.value("is_commit_clean", false) ? "" : " with changes");
}

/// Nothing if both are the same program, or of the same commit without changes.
std::string other_code(const Json& ours, const Json& theirs) {
  const std::string program = ours.value("program_sha256", "");
  if (!program.empty() && program == theirs.value("program_sha256", "")) return "";
  const std::string our_code = code_text(ours);
  const std::string their_code = code_text(theirs);
  const bool is_known = our_code != "unknown" && ours.value("is_commit_clean", false);
  if (is_known && ours.value("commit", "") == theirs.value("commit", "") &&
      their_code == our_code) {
    return "";
  }
  return their_code + ", here " + our_code;
}

}  // namespace

std::string published_otherwise(const Experiment& experiment, const fs::path& folder,
                                const fs::path& published) {
  const std::string name = experiment.slug + ".manifest.json";
  const Json ours = read_manifest(folder / name);
  const Json theirs = read_manifest(published / name);
  if (ours.is_null() || theirs.is_null()) return "";
  try {
    const std::string settings =
        other_settings(object_at(ours, "/config/as_run"), object_at(theirs, "/config/as_run"));
    const std::string code = other_code(ours, theirs);
    if (settings.empty() && code.empty()) return "";
    return "published " + (settings.empty() ? "" : "with other settings: " + settings) +
           (settings.empty() || code.empty() ? "" : "; ") +
           (code.empty() ? "" : "by other code: " + code);
  } catch (const Json::exception&) {
    throw geometry::InvalidInput((published / name).string() + " or " + (folder / name).string() +
                                 ": is damaged");
  }
}

}  // namespace graspfit::experiments
