#pragma once

#include <boost/program_options/options_description.hpp>

#include "cli/command_line.hpp"
#include "graspfit/grasp/planner_options.hpp"
#include "graspfit/grasp/planner_presets.hpp"

namespace graspfit::app {

/// Flags of the object's voxels and score map: part of the planner's, and all that inspect needs.
boost::program_options::options_description score_map_options();

/// Flags of everything else that decides what the planner does.
boost::program_options::options_description planner_options();

/// Sets what the flags of `score_map_options` say, each checked. @throws UsageError, InvalidInput:
/// flag, value and range.
void read_score_map_flags(const Flags& flags, grasp::PlannerOptions& options);

/// What all planner flags say, validated. @throws UsageError, InvalidInput.
grasp::PlannerOptions read_planner_flags(const Flags& flags);

/// "refine off, guard voxels": what a preset sets, as flags.
std::string preset_values_text(const grasp::PlannerPreset& preset);

}  // namespace graspfit::app
