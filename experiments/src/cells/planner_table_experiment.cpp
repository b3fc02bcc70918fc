#include "cells/planner_table_experiment.hpp"

#include "cells/planning_table.hpp"
#include "graspfit/experiments/planning_settings.hpp"

namespace graspfit::experiments::internal {
namespace planner_table_experiment_parts {
namespace {

constexpr std::size_t kGraspsKept = 10;  // Per cell; the goals of these tables are about so many.

sweep::CellResult run(const sweep::Cell& cell, const std::filesystem::path& folder) {
  const Planned planned = plan(planning_settings(cell));
  sweep::CellResult result{sweep::ResultRow(planning_columns()),
                           sweep::ResultRow(planning_timings())};
  fill_planning_columns(planned, result.row);
  fill_planning_timings(planned, result.timings);
  write_best_grasps(folder, planned, kGraspsKept);
  return result;
}

}  // namespace
}  // namespace planner_table_experiment_parts

sweep::Experiment planner_table_experiment(const std::string& slug) {
  using namespace planner_table_experiment_parts;
  return {
      .slug = slug,
      .columns = planning_columns(),
      .timings = planning_timings(),
      .check = [](const sweep::Cell& cell) { planning_settings(cell); },
      .run = run,
      .inputs = [](const sweep::Cell& cell) { return planning_inputs(planning_settings(cell)); }};
}

}  // namespace graspfit::experiments::internal
