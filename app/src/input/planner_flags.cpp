#include "input/planner_flags.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "graspfit/base/list_text.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/grasp/planner_option_table.hpp"
#include "graspfit/grasp/planner_presets.hpp"

namespace graspfit::app {
namespace {

namespace po = boost::program_options;
namespace groups = grasp::option_group;
using grasp::OptionKind;
using grasp::OptionValue;
using grasp::PlannerOption;
using grasp::PlannerOptions;

/// Placeholder of the flag's value in the help.
std::string value_name(const PlannerOption& option) {
  switch (option.kind) {
    case OptionKind::Number:
      return "NUMBER";
    case OptionKind::Integer:
      return "INTEGER";
    case OptionKind::YesNo:
      return std::string(option.yes) + '|' + std::string(option.no);
    case OptionKind::Choice:
      return option.choices_text();
    case OptionKind::Names:
      return "A,B,...";
    case OptionKind::Direction:
      return "X,Y,Z";
  }
  return "";
}

/// An option's description: "how raw scores become comparable with the threshold [R, A1]".
std::string description_of(const PlannerOption& option) {
  std::string text(option.meaning);
  if (option.is_number()) text += ", " + option.range.text();
  return text + option.source_text();
}

/// Whether an option is the palm's, whose flag is a switch, and so is the opposite flag.
bool is_palm(const PlannerOption& option) { return option.name == "palm"; }

void add_flag(po::options_description& options, const PlannerOption& option) {
  const std::string name(option.name);
  if (is_palm(option)) {
    add_switch(options, name, description_of(option));
    add_switch(options, "no-palm", "power grasps: the palm need not touch");
    return;
  }
  std::optional<std::string> fallback;
  if (!option.fallback.empty()) fallback = option.fallback;
  if (fallback && option.kind == OptionKind::YesNo) {
    fallback = fallback == "true" ? option.yes : option.no;
  }
  add_option(options, name, value_name(option), fallback, description_of(option));
}

void add_flags(po::options_description& options, std::string_view group) {
  for (const PlannerOption& option : grasp::planner_option_table()) {
    if (option.group == group) add_flag(options, option);
  }
}

std::string preset_names(std::string_view separator) {
  return base::list_text(grasp::planner_presets(), &grasp::PlannerPreset::name, separator);
}

/// A value of a preset as a flag: "refine off".
std::string flag_text(std::string_view name, const OptionValue& value) {
  for (const PlannerOption& option : grasp::planner_option_table()) {
    if (option.name != name) continue;
    if (const bool* const is_yes = std::get_if<bool>(&value)) {
      return std::string(name) + ' ' + std::string(*is_yes ? option.yes : option.no);
    }
  }
  return std::string(name) + ' ' + grasp::value_text(value);
}

/// The presets' description: "paper: the paper's grasps ... (refine off, guard voxels). fast: ...".
std::string preset_description() {
  std::string text = "options that go together, of which flags beside it change some.";
  for (const grasp::PlannerPreset& preset : grasp::planner_presets()) {
    text += ' ' + std::string(preset.name) + ": " + std::string(preset.meaning) + " (" +
            preset_values_text(preset) + ").";
  }
  return text + " Without: " + std::string(grasp::kDefaultPreset) +
         ", or exact with another planner or target-search than that has";
}

po::options_description flags_of(std::string_view group) {
  po::options_description options = option_group(std::string(group));
  add_flags(options, group);
  return options;
}

}  // namespace

std::string preset_values_text(const grasp::PlannerPreset& preset) {
  return base::list_text(preset.values,
                         [](const auto& value) { return flag_text(value.first, value.second); });
}

po::options_description score_map_options() { return flags_of(groups::kScores); }

po::options_description planner_options() {
  po::options_description request = option_group(std::string(groups::kRequest));
  add_option(request, "preset", preset_names("|"), std::nullopt, preset_description());
  add_option(request, "hand", "NAME|FILE", "barrett",
             "a shipped hand (graspfit hand list), or the description of any hand: URDF, MJCF or "
             "GraspIt! XML; what no sidecar beside it says is derived");
  add_flags(request, groups::kRequest);
  po::options_description search = flags_of(groups::kSearch);
  add_option(search, "seed", "INTEGER", std::to_string(PlannerOptions{}.seed),
             "of the random numbers; same seed, same grasps, by one build "
             "on one processor");
  add_option(search, "threads", "INTEGER", "0",
             "attempts side by side; 0: as many as the machine has; the grasps do not depend on "
             "it");
  po::options_description target = flags_of(groups::kTargets);
  add_switch(target, "no-weak", "look for no fragile features: S = 1 everywhere [R, A37]");
  po::options_description all = option_group();
  all.add(request).add(search).add(flags_of(groups::kDistinct)).add(target);
  return all.add(flags_of(groups::kContacts))
      .add(flags_of(groups::kForces))
      .add(flags_of(groups::kMeasure));
}

namespace {

OptionValue value_of(const Flags& flags, const PlannerOption& option) {
  const std::string name(option.name);
  switch (option.kind) {
    case OptionKind::Number:
      return flags.number(name, option.range);
    case OptionKind::Integer:
      return std::int64_t{flags.integer(name, option.range)};
    case OptionKind::YesNo:
      return flags.either(name, std::string(option.yes).c_str(), std::string(option.no).c_str());
    case OptionKind::Names:
      return flags.words(name);
    case OptionKind::Choice: {
      const std::string text = flags.text(name);
      if (!option.has_choice(text)) fail_choice(name, text, option.choices_text());
      return text;
    }
    case OptionKind::Direction:
      break;
  }
  return flags.vector(name);
}

/// Sets the options that the flags of a group give, or the flags of all groups if `group` is empty.
/// Defaults stay as they are to the last bit.
void read_flags(const Flags& flags, std::string_view group, PlannerOptions& options) {
  for (const PlannerOption& option : grasp::planner_option_table()) {
    const std::string name(option.name);
    if (!group.empty() && option.group != group) continue;
    if (is_palm(option) || !flags.has(name) || flags.is_default(name)) continue;
    grasp::set_option(options, option, value_of(flags, option));
  }
}

/// Refuses flags that mean nothing without others.
void require_compatible_flags(const Flags& flags, const PlannerOptions& options) {
  const auto require_meaning = [&](const char* flag, bool has_meaning, const std::string& why) {
    if (has_meaning || !flags.has(flag) || flags.is_default(flag)) return;
    throw UsageError("--" + std::string(flag) + " means nothing " + why);
  };
  require_meaning("approach-angle-deg", flags.has("approach"), "without --approach");
  for (const char* flag : {"exclude-weak", "weak-thickness-mm"}) {
    require_meaning(flag, !flags.has("no-weak"), "with --no-weak");
  }
  require_meaning("largest-deviation-mm", options.rejection == grasp::Rejection::Deviation,
                  "without --reject deviation");
  for (const auto& [flag, prefix] : {std::pair("gs-sampling", "gs"), std::pair("gs-samples", "gs"),
                                     std::pair("ma-samples", "ma")}) {
    require_meaning(flag, options.planner.starts_with(prefix), "with --planner " + options.planner);
  }
  if (flags.has("palm") && flags.has("no-palm")) {
    throw UsageError("--palm and --no-palm exclude each other");
  }
}

void validate_flags(const PlannerOptions& options) {
  try {
    experiments::require_compatible(options);
  } catch (const sweep::SettingError& error) {
    throw UsageError("--" + error.key() + ' ' + error.what());
  }
  options.validate();
}

}  // namespace

void read_score_map_flags(const Flags& flags, PlannerOptions& options) {
  read_flags(flags, groups::kScores, options);
}

std::string preset_name(const Flags& flags) {
  if (flags.has("preset")) return flags.text("preset");
  PlannerOptions options;
  grasp::apply_preset(options, *grasp::preset_named(grasp::kDefaultPreset));
  const auto is_kept = [&](const char* flag, std::string_view value) {
    return !flags.has(flag) || flags.is_default(flag) || flags.text(flag) == value;
  };
  const bool is_kept_whole = is_kept("planner", options.planner) &&
                             is_kept("target-search", grasp::name_of(options.targets.search));
  return std::string(is_kept_whole ? grasp::kDefaultPreset : "exact");
}

PlannerOptions read_planner_flags(const Flags& flags) {
  if (flags.has("fingers") && !flags.is_default("contacts") &&
      flags.integer("contacts") != std::ssize(flags.words("fingers"))) {
    throw UsageError("--contacts " + flags.text("contacts") + " contradicts the " +
                     std::to_string(flags.words("fingers").size()) + " named by --fingers");
  }
  PlannerOptions options;
  const std::string name = preset_name(flags);
  const grasp::PlannerPreset* const preset = grasp::preset_named(name);
  if (preset == nullptr) fail_choice("preset", name, preset_names("|"));
  grasp::apply_preset(options, *preset);
  read_flags(flags, "", options);
  options.seed = flags.unsigned_integer("seed");
  require_compatible_flags(flags, options);
  if (flags.has("palm")) options.palm = true;
  if (flags.has("no-palm")) options.palm = false;
  if (flags.has("no-weak")) options.weak.reset();
  validate_flags(options);
  return options;
}

}  // namespace graspfit::app
