#pragma once

#include <boost/program_options/options_description.hpp>
#include <string>

#include "cli/command_line.hpp"
#include "graspfit/grasp/planner_options.hpp"
#include "graspfit/grasp/planner_presets.hpp"

namespace graspfit::app {

/// Flags of the object's voxels and score map: some of the planner's flags, and all that `inspect`
/// needs.
boost::program_options::options_description score_map_options();

/// All other flags that decide what the planner does.
boost::program_options::options_description planner_options();

/// Sets the options that the flags of `score_map_options` give, and checks each.
/// @throws UsageError, InvalidInput with flag, value and range.
void read_score_map_flags(const Flags& flags, grasp::PlannerOptions& options);

/// The preset that the options start from: the one asked for; else `grasp::kDefaultPreset`, or
/// "exact" where another planner or target search is asked for than that has.
std::string preset_name(const Flags& flags);

/// The options that all planner flags give, validated. @throws UsageError, InvalidInput.
grasp::PlannerOptions read_planner_flags(const Flags& flags);

/// The options that a preset sets, as flags: "refine off, guard voxels".
std::string preset_values_text(const grasp::PlannerPreset& preset);

}  // namespace graspfit::app
