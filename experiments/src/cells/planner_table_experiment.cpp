#include "cells/planner_table_experiment.hpp"

#include "graspfit/experiments/planning_settings.hpp"

namespace graspfit::experiments::internal {

sweep::Experiment planner_table_experiment(const std::string& slug, const OwnColumns& own) {
  std::vector<sweep::Column> columns = own.columns;
  for (sweep::Column& column : planning_columns()) columns.push_back(std::move(column));
  const auto run = [columns, fill_own = own.fill](const sweep::Cell& cell,
                                                  const std::filesystem::path& folder) {
    const Planned planned = plan(planning_settings(cell));
    sweep::CellResult result{sweep::ResultRow(columns), sweep::ResultRow(planning_timings())};
    if (fill_own) fill_own(planned, result.row);
    fill_planning_columns(planned, result.row);
    fill_planning_timings(planned, result.timings);
    write_best_grasps(folder, planned, kGraspsKept);
    return result;
  };
  return {
      .slug = slug,
      .columns = columns,
      .timings = planning_timings(),
      .check = [](const sweep::Cell& cell) { planning_settings(cell); },
      .run = run,
      .inputs = [](const sweep::Cell& cell) { return planning_inputs(planning_settings(cell)); }};
}

}  // namespace graspfit::experiments::internal
