#include <nlohmann/json.hpp>
#include <system_error>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/json_bounds.hpp"
#include "graspfit/sweep/table_comparison.hpp"

namespace graspfit::sweep {
namespace {

namespace fs = std::filesystem;
using SortedJson = nlohmann::json;

SortedJson read_manifest(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return {};
  SortedJson json = SortedJson::parse(base::read_json_file(file), nullptr, false);
  if (!json.is_object()) throw base::InvalidInput(file.string() + ": is damaged");
  return json;
}

/// A member as an object; empty if there is none.
SortedJson object_at(const SortedJson& json, const char* pointer) {
  const SortedJson::json_pointer member(pointer);
  return json.contains(member) && json.at(member).is_object() ? json.at(member)
                                                              : SortedJson::object();
}

std::string text_of(const SortedJson& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

/// Differences of settings as "name theirs, here ours".
class Differences {
 public:
  void compare(const std::string& name, const SortedJson* ours, const SortedJson* theirs) {
    if (ours != nullptr && theirs != nullptr && *ours == *theirs) return;
    text_ += (text_.empty() ? "" : "; ") + name + ' ' + value(theirs) + ", here " + value(ours);
  }

  /// All members that one of two objects has.
  void compare_members(const std::string& prefix, const SortedJson& ours,
                       const SortedJson& theirs) {
    SortedJson all = ours;
    all.update(theirs);
    for (const auto& [name, value] : all.items()) {
      compare(prefix + name, find(ours, name), find(theirs, name));
    }
  }

  const std::string& text() const { return text_; }

 private:
  static const SortedJson* find(const SortedJson& object, const std::string& name) {
    const auto found = object.find(name);
    return found == object.end() ? nullptr : &*found;
  }
  static std::string value(const SortedJson* value) {
    return value ? text_of(*value) : "not given";
  }

  std::string text_;
};

/// Label -> settings of each axis's values, by the axis's name.
SortedJson values_by_label(const SortedJson& as_run) {
  SortedJson axes = SortedJson::object();
  if (!as_run.contains("axes")) return axes;
  for (const SortedJson& axis : as_run.at("axes")) {
    SortedJson& values = axes[axis.at("name").get<std::string>()] = SortedJson::object();
    for (const SortedJson& value : axis.at("values")) {
      values[value.at("label").get<std::string>()] = value.at("settings");
    }
  }
  return axes;
}

std::string other_settings(const SortedJson& ours, const SortedJson& theirs) {
  Differences differences;
  const auto seed_of = [](const SortedJson& as_run) {
    return as_run.contains("seed") ? as_run.at("seed") : SortedJson();
  };
  const SortedJson our_seed = seed_of(ours);
  const SortedJson their_seed = seed_of(theirs);
  differences.compare("seed", &our_seed, &their_seed);
  differences.compare_members("", object_at(ours, "/settings"), object_at(theirs, "/settings"));
  const SortedJson our_axes = values_by_label(ours);
  const SortedJson their_axes = values_by_label(theirs);
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
std::string code_text(const SortedJson& manifest) {
  constexpr std::size_t kShort = 7;
  const std::string commit = manifest.value("commit", "");
  if (commit.empty()) return "unknown";
  return "commit " + commit.substr(0, kShort) +
         (manifest.value("is_commit_clean", false) ? "" : " with changes");
}

/// Says how the code differs; empty if both are the same program, or of the same commit without
/// changes.
std::string other_code(const SortedJson& ours, const SortedJson& theirs) {
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
  const SortedJson ours = read_manifest(folder / name);
  const SortedJson theirs = read_manifest(published / name);
  if (ours.is_null() || theirs.is_null()) return "";
  try {
    const std::string settings =
        other_settings(object_at(ours, "/config/as_run"), object_at(theirs, "/config/as_run"));
    const std::string code = other_code(ours, theirs);
    if (settings.empty() && code.empty()) return "";
    return "published " + (settings.empty() ? "" : "with other settings: " + settings) +
           (settings.empty() || code.empty() ? "" : "; ") +
           (code.empty() ? "" : "by other code: " + code);
  } catch (const SortedJson::exception&) {
    throw base::InvalidInput((published / name).string() + " or " + (folder / name).string() +
                             ": is damaged");
  }
}

}  // namespace graspfit::sweep
