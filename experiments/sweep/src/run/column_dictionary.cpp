#include "graspfit/sweep/column_dictionary.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace graspfit::sweep {
namespace {

using Json = nlohmann::ordered_json;

Json entry(const Column& column) {
  return {{"name", column.name}, {"unit", column.unit}, {"meaning", column.meaning}};
}

/// Returns the column of an axis. An axis named after a setting holds values of that setting; the
/// labels of any other axis are names.
Column axis_column(const Axis& axis, const Experiment& experiment) {
  if (axis.name == "seed") return {"seed", "1", "number of the repetition; see cell_seed"};
  for (const auto* const names : {&experiment.shared_settings, &experiment.settings}) {
    const auto found = std::find_if(names->begin(), names->end(), [&](const Column& setting) {
      return setting.name == axis.name;
    });
    if (found != names->end()) return *found;
  }
  return {axis.name, "", "name of the axis's value in configs/" + experiment.slug + ".json"};
}

Json table(const std::vector<Column>& first, const std::vector<Column>& second,
           const std::vector<Column>& third) {
  Json entries = Json::array();
  for (const auto* const columns : {&first, &second, &third}) {
    for (const Column& column : *columns) entries.push_back(entry(column));
  }
  return entries;
}

}  // namespace

std::string column_dictionary(const Experiment& experiment, const ExperimentConfig& config) {
  std::vector<Column> axes;
  for (const Axis& axis : config.sweep.axes) axes.push_back(axis_column(axis, experiment));
  const std::vector<Column> cell = {
      {"cell_seed", "1",
       "the cell's seed: its planner's, where it runs one and planner-seed is not set"},
      {"status", "", "ok, failed (the reason says why, results are empty) or skipped (no data)"},
      {"reason", "", "why the cell is not ok"}};
  const std::vector<Column> times = {{"wall_s", "s", "the cell by the clock"},
                                     {"cpu_s", "s", "processor time of the cell"}};
  Json tables;
  tables[experiment.slug + ".csv"] = table(axes, cell, experiment.columns);
  tables[experiment.slug + ".timing.csv"] = table(axes, times, experiment.timings);
  if (!experiment.details.empty()) {
    tables[experiment.slug + ".details.csv"] = table(axes, {}, experiment.details);
  }
  for (const SummaryTable& summary : experiment.summaries) {
    tables[experiment.slug + '.' + summary.name + ".csv"] = table({}, {}, summary.columns);
  }
  const Json dictionary = {{"experiment", experiment.slug}, {"tables", tables}};
  return dictionary.dump(2) + '\n';
}

}  // namespace graspfit::sweep
