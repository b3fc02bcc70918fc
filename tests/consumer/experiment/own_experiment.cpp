// This is an experiment of one's own on a mesh of one's own: a column that graspfit does not have,
// over resolution, alpha, beta and a threshold. It writes its table into the folder of the program.
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/sweep/sweep_runner.hpp"

using namespace graspfit;

std::vector<sweep::Column> columns() {
  return {{"grasps", "1", "distinct usable grasps"},
          {"best_m", "1", "M of the best one"},
          {"palm_spread_m", "m", "largest distance of two of their palms, if there are two"}};
}

// Computes one cell on one thread; several cells may run at once.
sweep::CellResult run(const sweep::Cell& cell, const std::filesystem::path&) {
  const experiments::PlanningSettings settings = experiments::planning_settings(cell);
  const auto object_file = experiments::load_object(settings.object);
  const auto hand = experiments::load_hand(settings.hand);
  const grasp::ObjectModel object =
      grasp::prepare_object(object_file->mesh, *hand, settings.options);
  const std::vector<grasp::Grasp> grasps =
      grasp::plan_grasps(object, *hand, settings.options, {}, {.num_threads = 1}).grasps;

  double spread = 0.0;
  for (const grasp::Grasp& a : grasps) {
    for (const grasp::Grasp& b : grasps) {
      const Eigen::Vector3d way =
          a.configuration.X_OH * hand->palm.center_H - b.configuration.X_OH * hand->palm.center_H;
      spread = std::max(spread, way.norm());
    }
  }
  sweep::CellResult result{sweep::ResultRow(columns()), sweep::ResultRow({})};
  result.row.set("grasps", static_cast<std::int64_t>(grasps.size()));
  if (!grasps.empty()) result.row.set("best_m", grasps.front().quality.m);
  if (grasps.size() > 1) result.row.set("palm_spread_m", spread);
  return result;
}

int main(int, char** argv) {
  const std::filesystem::path folder = std::filesystem::absolute(argv[0]).parent_path() / "results";
  std::filesystem::create_directories(folder);
  const std::filesystem::path mesh = folder / "cube.off";
  geometry::write_mesh(mesh, geometry::box({0.05, 0.05, 0.05}));

  sweep::Experiment experiment;
  experiment.slug = "grasp_spread";
  experiment.columns = columns();
  experiment.shared_settings = experiments::planning_setting_names();
  experiment.check = [](const sweep::Cell& cell) { experiments::planning_settings(cell); };
  experiment.run = run;
  experiment.inputs = [](const sweep::Cell& cell) {
    return experiments::planning_inputs(experiments::planning_settings(cell));
  };

  // This mesh takes the place of the configuration's object, as `--object cube.off` would.
  const sweep::ExperimentConfig config =
      sweep::read_config(experiment, CONFIGURATION, {.object_files = {mesh}});
  const sweep::RunProgress done =
      sweep::run_sweep(experiment, config, {.command = "own_experiment", .versions = {}},
                       {.folder = folder, .jobs = 2});
  std::printf("%zu cells, %zu failed, %zu skipped\n", done.num_cells, done.num_failed,
              done.num_skipped);
  return done.num_cells == 5 && done.num_failed == 0 && done.num_skipped == 0 ? 0 : 1;
}
