#include "graspfit/experiments/experiment.hpp"
#include "internal/experiment_list.hpp"

namespace graspfit::experiments {

const std::vector<Experiment>& all_experiments() {
  static const std::vector<Experiment> experiments = {
      internal::force_closure(),    internal::hold_prediction(),  internal::hold_rates(),
      internal::parameter_sweeps(), internal::planner_everyday(), internal::planner_paper_objects(),
      internal::special_cases(),    internal::table_tidying(),
  };
  return experiments;
}

const Experiment& find_experiment(const std::string& slug) {
  std::string names;
  for (const Experiment& experiment : all_experiments()) {
    if (experiment.slug == slug) return experiment;
    names += (names.empty() ? "" : ", ") + experiment.slug;
  }
  throw geometry::InvalidInput("no experiment named " + slug + "; there are " + names);
}

}  // namespace graspfit::experiments
