#include "graspfit/experiments/experiment_registry.hpp"

#include "cells/hold_cell.hpp"
#include "cells/method_table.hpp"
#include "cells/planner_table_experiment.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/nearest_name.hpp"
#include "graspfit/experiments/grasp_dataset.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "list/experiment_list.hpp"

namespace graspfit::experiments {

namespace {

using sweep::Experiment;

/// In the order of their slugs. What each asks and how it is answered stands in
/// `configs/<slug>.json`.
std::vector<Experiment> listed_experiments() {
  using namespace internal;
  return {
      candidate_prediction(),
      contacts_and_time(),
      fitting_stages(),
      force_closure(),
      from_table(),
      guidance_models(),
      hold_experiment("hold_choices"),
      hold_experiment("hold_default"),
      hold_prediction(),
      hold_rates(),
      measured_contacts(),
      multidex_objects(),
      object_voxels(),
      planner_table_experiment("paper_grasps"),
      parameter_sweeps(),
      planner_table_experiment("planner_everyday"),
      planner_table_experiment("planner_paper_objects"),
      reach_grasps(),
      special_cases(),
      method_experiment("table1"),
      method_experiment("table1_all_objects"),
      method_experiment("table1_readings", {.row = "reading", .group = "reading"}),
      method_experiment("table1_refined"),
      table_tidying(),
  };
}

}  // namespace

const std::vector<Experiment>& all_experiments() {
  static const std::vector<Experiment> experiments = [] {
    std::vector<Experiment> listed = listed_experiments();
    for (Experiment& experiment : listed) experiment.shared_settings = planning_setting_names();
    return listed;
  }();
  return experiments;
}

const sweep::Experiment& find_experiment(std::string_view slug) {
  if (slug == kDatasetSlug) return dataset_experiment();
  std::vector<std::string> slugs;
  for (const sweep::Experiment& experiment : all_experiments()) {
    if (experiment.slug == slug) return experiment;
    slugs.push_back(experiment.slug);
  }
  const std::string name(slug);
  throw base::InvalidInput("no experiment named " + name + "; there are " +
                           base::known_names(name, slugs));
}

}  // namespace graspfit::experiments
