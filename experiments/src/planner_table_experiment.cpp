#include "internal/planner_table_experiment.hpp"

#include "graspfit/experiments/planning_settings.hpp"
#include "internal/planning_table.hpp"

namespace graspfit::experiments::internal {
namespace {

constexpr std::size_t kGraspsKept = 10;  // Per cell: what the goals of these tables speak of.

CellResult run(const Cell& cell, const std::filesystem::path& folder) {
  const Planned planned = plan(planning_settings(cell));
  CellResult result{ResultRow(planning_columns()), ResultRow(planning_timings())};
  fill_planning_columns(planned, result.row);
  fill_planning_timings(planned, result.timings);
  write_best_grasps(folder, planned, kGraspsKept);
  return result;
}

}  // namespace

Experiment planner_table_experiment(const std::string& slug) {
  Experiment experiment;
  experiment.slug = slug;
  experiment.columns = planning_columns();
  experiment.timings = planning_timings();
  experiment.check = [](const Cell& cell) { planning_settings(cell); };
  experiment.run = run;
  experiment.inputs = [](const Cell& cell) { return planning_inputs(planning_settings(cell)); };
  return experiment;
}

}  // namespace graspfit::experiments::internal
