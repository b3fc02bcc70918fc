// Question: how do quality, usable rate and time depend on the planner's parameters, one at a time
// around their defaults: the resolution of the voxels, alpha and beta of the measure, the score
// that targets must exceed, and the half-angle of the friction cones?
//
// Answered by one row per object and value of a parameter: the columns of the planner's tables
// beside `parameter` and `value`, so that a plot of any column over the value is a filter and a
// sort. A parameter that matters moves usable_rate or mean_m by more than its neighbors' scatter,
// which the repeated defaults (each parameter has its own) show.

#include "cells/planning_table.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/sweep/setting_value.hpp"
#include "list/experiment_list.hpp"

namespace graspfit::experiments::internal {
namespace parameter_sweeps_parts {
namespace {

std::vector<sweep::Column> own_settings() {
  return {{"parameter", "", "name of the setting that is varied; a number"}};
}

/// The parameter of a cell and its value.
struct Varied {
  std::string parameter;
  double value = 0.0;
};

Varied varied_of(const sweep::Cell& cell) {
  const base::JsonValue parameter = sweep::setting(cell, "parameter");
  const std::string name = parameter.name();
  const auto value = sweep::find_setting(cell, name);
  if (!value) parameter.refuse("must be the name of a setting that is given");
  return {name, value->number()};
}

sweep::CellResult run(const sweep::Cell& cell) {
  const Varied varied = varied_of(cell);
  const Planned planned = plan(planning_settings(cell, own_settings()));
  sweep::Experiment experiment = parameter_sweeps();
  sweep::CellResult result{sweep::ResultRow(experiment.columns),
                           sweep::ResultRow(experiment.timings)};
  result.row.set("parameter", varied.parameter);
  result.row.set("value", varied.value);
  fill_planning_columns(planned, result.row);
  fill_planning_timings(planned, result.timings);
  return result;
}

}  // namespace
}  // namespace parameter_sweeps_parts

sweep::Experiment parameter_sweeps() {
  using namespace parameter_sweeps_parts;
  std::vector<sweep::Column> columns = {
      {"parameter", "", "the setting that is varied; all others have defaults"},
      {"value", "", "its value, in the unit that describe states"}};
  for (const sweep::Column& column : planning_columns()) columns.push_back(column);
  return {
      .slug = "parameter_sweeps",
      .columns = std::move(columns),
      .timings = planning_timings(),
      .settings = own_settings(),
      .check =
          [](const sweep::Cell& cell) {
            varied_of(cell);
            planning_settings(cell, own_settings());
          },
      .run = [](const sweep::Cell& cell, const std::filesystem::path&) { return run(cell); },
      .inputs =
          [](const sweep::Cell& cell) {
            return planning_inputs(planning_settings(cell, own_settings()));
          },
  };
}

}  // namespace graspfit::experiments::internal
