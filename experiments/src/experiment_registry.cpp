#include "graspfit/experiments/experiment.hpp"
#include "graspfit/geometry/nearest_name.hpp"
#include "internal/experiment_list.hpp"

namespace graspfit::experiments {

const std::vector<Experiment>& all_experiments() {
  static const std::vector<Experiment> experiments = {
      internal::contacts_and_time(),
      internal::fitting_stages(),
      internal::force_closure(),
      internal::guidance_models(),
      internal::hold_choices(),
      internal::hold_prediction(),
      internal::hold_rates(),
      internal::measured_contacts(),
      internal::object_voxels(),
      internal::paper_grasps(),
      internal::parameter_sweeps(),
      internal::planner_everyday(),
      internal::planner_paper_objects(),
      internal::special_cases(),
      internal::table1(),
      internal::table1_all_objects(),
      internal::table1_readings(),
      internal::table1_refined(),
      internal::table_tidying(),
  };
  return experiments;
}

const Experiment& find_experiment(std::string_view slug) {
  std::vector<std::string> slugs;
  std::string names;
  for (const Experiment& experiment : all_experiments()) {
    if (experiment.slug == slug) return experiment;
    slugs.push_back(experiment.slug);
    names += (names.empty() ? "" : ", ") + experiment.slug;
  }
  const std::string name(slug);
  throw geometry::InvalidInput("no experiment named " + name + "; there are " + names +
                               geometry::did_you_mean(name, slugs));
}

}  // namespace graspfit::experiments
