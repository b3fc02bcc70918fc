// Question: how do quality, usable rate and time depend on the planner's parameters, one at a time
// around their defaults: the resolution of the voxels, alpha and beta of the measure, the score
// that targets must exceed, and the half-angle of the friction cones?
//
// Answered by one row per object and value of a parameter: the columns of the planner's tables
// beside `parameter` and `value`, so that a plot of any column over the value is a filter and a
// sort. A parameter that matters moves usable_rate or mean_m by more than its neighbors' scatter,
// which the repeated defaults (each parameter has its own) show.
#include <nlohmann/json.hpp>

#include "graspfit/experiments/planning_settings.hpp"
#include "internal/experiment_list.hpp"
#include "internal/planning_table.hpp"
#include "internal/setting_value.hpp"

namespace graspfit::experiments::internal {
namespace {

std::vector<Column> own_settings() {
  return {{"parameter", "", "name of the setting that is varied; a number"}};
}

/// The parameter of a cell and its value.
struct Varied {
  std::string parameter;
  double value = 0.0;
};

Varied varied_of(const Cell& cell) {
  const nlohmann::json json = nlohmann::json::parse(cell.settings);
  if (!json.contains("parameter")) throw SettingError("", "there is no setting parameter");
  const SettingValue parameter("parameter", json.at("parameter"));
  const std::string name = parameter.text();
  if (!json.contains(name)) parameter.fail("must be the name of a setting that is given");
  return {name, SettingValue(name, json.at(name)).number()};
}

CellResult run(const Cell& cell) {
  const Varied varied = varied_of(cell);
  const Planned planned = plan(planning_settings(cell, own_settings()));
  Experiment experiment = parameter_sweeps();
  CellResult result{ResultRow(experiment.columns), ResultRow(experiment.timings)};
  result.row.set("parameter", varied.parameter);
  result.row.set("value", varied.value);
  fill_planning_columns(planned, result.row);
  fill_planning_timings(planned, result.timings);
  return result;
}

}  // namespace

Experiment parameter_sweeps() {
  Experiment experiment;
  experiment.slug = "parameter_sweeps";
  experiment.columns = {{"parameter", "", "the setting that is varied; all others have defaults"},
                        {"value", "", "its value, in the unit that describe states"}};
  for (const Column& column : planning_columns()) experiment.columns.push_back(column);
  experiment.timings = planning_timings();
  experiment.settings = own_settings();
  experiment.check = [](const Cell& cell) {
    varied_of(cell);
    planning_settings(cell, own_settings());
  };
  experiment.run = [](const Cell& cell, const std::filesystem::path&) { return run(cell); };
  experiment.inputs = [](const Cell& cell) {
    return planning_inputs(planning_settings(cell, own_settings()));
  };
  return experiment;
}

}  // namespace graspfit::experiments::internal
