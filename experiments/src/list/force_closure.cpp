// Question: how many of the planner's valid grasps, in the order in which it finds them, are force
// closed at a friction at which other planners are judged (0.4), and how large is their epsilon
// (GraspIt!'s convention)? What does it cost to have force-closed ones only? And does it help to
// look for targets with the friction cone of that friction, instead of the paper's 45 degrees, to
// have the palm touch too, and to slide touching pads toward their targets?
//
// Answered by one row per kind of grasp and cone half-angle: the first `sample` valid grasps as
// they come, and beside them the first `sample` of those with an epsilon of at least
// `least_epsilon` ("selected"), each with the attempts and the processor time that they took. At
// least 0.6 in `closed_share` with a median epsilon above 0.05, unselected, is what is aimed at.
#include <algorithm>

#include "cells/planning_table.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/sweep/setting_value.hpp"
#include "list/experiment_list.hpp"

namespace graspfit::experiments::internal {
namespace force_closure_parts {
namespace {

/// What the experiment reads beside the planner's settings.
struct Sampling {
  int sample = 0;
  double least_epsilon = 0.0;
};

std::vector<sweep::Column> own_settings() {
  return {{"sample", "1", "grasps looked at, the first ones found; from 1, at most count"},
          {"least_epsilon", "1", "epsilon from which a grasp is among the selected ones"}};
}

Sampling sampling_of(const sweep::Cell& cell) {
  const base::JsonValue sample = sweep::setting(cell, "sample");
  const base::JsonValue least = sweep::setting(cell, "least_epsilon");
  if (sample.small_integer() < 1) sample.refuse("must be >= 1");
  return {sample.small_integer(), least.positive_number()};
}

PlanningSettings settings_of(const sweep::Cell& cell) {
  PlanningSettings settings = planning_settings(cell, own_settings());
  // "First" stops at `count` grasps, which come as they are found: nothing is selected by M.
  if (settings.options.search != grasp::SearchRule::First) {
    throw sweep::SettingError("search", "must be first: others select by M");
  }
  if (settings.options.count < sampling_of(cell).sample) {
    throw sweep::SettingError("count", "must be at least sample");
  }
  return settings;
}

std::vector<sweep::Column> columns_of(const std::string& prefix, const std::string& which) {
  return {{prefix + "grasps", "1", which + "grasps found, at most `sample`"},
          {prefix + "attempts", "1", "attempts up to the last of them"},
          {prefix + "closed_share", "1", "share of them that is force closed (epsilon above 1e-9)"},
          {prefix + "median_epsilon", "1", "median of their epsilon, 0 without closure"},
          {prefix + "mean_epsilon", "1", "mean of the same"},
          {prefix + "mean_m", "1", "their mean M"}};
}

std::vector<sweep::Column> columns() {
  std::vector<sweep::Column> all = {{"friction", "1", "Coulomb's mu of closure and epsilon"},
                                    {"theta_max_rad", "rad", "half-angle of the friction cones"}};
  for (const auto& [prefix, which] :
       {std::pair("", "first valid "), std::pair("selected_", "first valid and selected ")}) {
    for (sweep::Column& column : columns_of(prefix, which)) all.push_back(std::move(column));
  }
  for (const auto& [name, meaning] :
       {std::pair("all_attempts", "attempts of the whole run"),
        std::pair("all_valid", "of these valid"),
        std::pair("all_grasps", "distinct valid grasps of the run")}) {
    all.push_back({name, "1", meaning});
  }
  return all;
}

std::vector<sweep::Column> timings() {
  std::vector<sweep::Column> all = {
      {"grasps_cpu_s", "s", "processor time up to the last of the first grasps, model excluded"},
      {"selected_cpu_s", "s", "processor time up to the last of the selected grasps"}};
  for (sweep::Column& column : planning_timings()) all.push_back(std::move(column));
  return all;
}

/// Epsilon of a grasp, but 0 for GraspIt!'s −1 where there is no closure, for means and medians.
double epsilon_of(const grasp::Grasp& grasp) { return std::max(0.0, grasp.epsilon()); }

/// Fills the columns of a sample. Returns the attempts that it took: up to its last grasp, or all
/// if it is not full.
std::int64_t fill(const std::string& prefix, const std::vector<const grasp::Grasp*>& sample,
                  bool is_full, const Planned& planned, sweep::ResultRow& row) {
  std::vector<double> epsilons;
  std::vector<double> ms;
  std::size_t closed = 0;
  for (const grasp::Grasp* grasp : sample) {
    epsilons.push_back(epsilon_of(*grasp));
    ms.push_back(grasp->quality.m);
    if (grasp->is_closed()) ++closed;
  }
  const std::int64_t attempts =
      is_full ? sample.back()->attempt + 1 : planned.result.statistics.attempts;
  row.set(prefix + "grasps", field(sample.size()));
  row.set(prefix + "attempts", attempts);
  if (!sample.empty()) {
    row.set(prefix + "closed_share",
            static_cast<double>(closed) / static_cast<double>(sample.size()));
  }
  row.set(prefix + "median_epsilon", field(median(epsilons)));
  row.set(prefix + "mean_epsilon", field(mean(epsilons)));
  row.set(prefix + "mean_m", field(mean(ms)));
  return attempts;
}

sweep::CellResult run(const sweep::Cell& cell, const std::filesystem::path& folder) {
  const Sampling sampling = sampling_of(cell);
  const Planned planned = plan(settings_of(cell));
  std::vector<const grasp::Grasp*> found;
  for (const grasp::Grasp& grasp : planned.result.grasps) found.push_back(&grasp);
  std::sort(found.begin(), found.end(),
            [](const grasp::Grasp* a, const grasp::Grasp* b) { return a->attempt < b->attempt; });
  std::vector<const grasp::Grasp*> selected;
  for (const grasp::Grasp* grasp : found) {
    if (epsilon_of(*grasp) >= sampling.least_epsilon) selected.push_back(grasp);
  }
  const auto size = static_cast<std::size_t>(sampling.sample);
  const auto cut = [&](std::vector<const grasp::Grasp*>& sample) {
    const bool is_full = sample.size() >= size;
    if (is_full) sample.resize(size);
    return is_full;
  };

  sweep::CellResult result{sweep::ResultRow(columns()), sweep::ResultRow(timings())};
  result.row.set("friction", planned.settings.options.friction);
  result.row.set("theta_max_rad", planned.settings.options.targets.theta_max);
  result.row.set("all_attempts", planned.result.statistics.attempts);
  result.row.set("all_valid", planned.result.statistics.valid());
  result.row.set("all_grasps", field(found.size()));
  const auto cpu_s = [&](std::int64_t attempts) -> sweep::Value {
    const auto index = static_cast<std::size_t>(attempts);
    if (index < 1 || index > planned.attempt_cpu_s.size()) return {};
    return planned.attempt_cpu_s[index - 1];
  };
  const bool has_all = cut(found);
  result.timings.set("grasps_cpu_s", cpu_s(fill("", found, has_all, planned, result.row)));
  const bool has_all_selected = cut(selected);
  result.timings.set("selected_cpu_s",
                     cpu_s(fill("selected_", selected, has_all_selected, planned, result.row)));
  fill_planning_timings(planned, result.timings);
  write_best_grasps(folder, planned, size);
  return result;
}

}  // namespace
}  // namespace force_closure_parts

sweep::Experiment force_closure() {
  using namespace force_closure_parts;
  return {.slug = "force_closure",
          .columns = columns(),
          .timings = timings(),
          .settings = own_settings(),
          .check =
              [](const sweep::Cell& cell) {
                sampling_of(cell);
                settings_of(cell);
              },
          .run = run,
          .inputs = [](const sweep::Cell& cell) { return planning_inputs(settings_of(cell)); }};
}

}  // namespace graspfit::experiments::internal
