#include "cells/method_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "cells/grasp_measures.hpp"
#include "cells/planning_table.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/grasp/fitting_hand.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/sweep/setting_value.hpp"

namespace graspfit::experiments::internal {
namespace method_table_parts {
namespace {

constexpr const char* kSeedSetting = "planner-seed";

std::vector<sweep::Column> own_settings() {
  return {{kSeedSetting, "1", "seed of the planner in every cell, so that no method has its own"}};
}

std::uint64_t planner_seed(const sweep::Cell& cell) {
  const base::JsonValue value = sweep::setting(cell, kSeedSetting);
  if (value.small_integer() < 0) value.refuse("must be >= 0");
  return static_cast<std::uint64_t>(value.small_integer());
}

PlanningSettings settings_of(const sweep::Cell& cell) {
  const PlanningSettings settings =
      planning_settings(cell.settings, planner_seed(cell), own_settings());
  // Selection by M would raise the means of whoever has more attempts.
  if (settings.options.search != grasp::SearchRule::First) {
    throw sweep::SettingError("search", "must be first: others select by M");
  }
  return settings;
}

std::vector<sweep::Column> details() {
  std::vector<sweep::Column> columns = {
      {"attempt", "1", "number of the attempt"},
      {"is_valid", "", "without penetration, every requested part in contact"},
      {"has_all_contacts", "", "every requested part in contact"},
      {"deepest_overlap_m", "m", "with the object or of the hand with itself"},
      {"d_min_voxels", "voxels", "smallest value of the signed map where the hand is"},
      {"area_share_median", "1", "median over the contacts of A over the area of the pad"},
      {"gap_median_m", "m", "median over the contacts of the gap"}};
  for (sweep::Column& column : grasp_measure_columns()) columns.push_back(std::move(column));
  return columns;
}

std::vector<sweep::Column> columns() {
  std::vector<sweep::Column> all = {
      {"hand", "", "name of the hand"},
      {"planner_seed", "1", "seed of the planner"},
      {"voxel_size_m", "m", "edge of a voxel"},
      {"clip_thickness_m", "m", "of clip volumes whose pads state none"},
      {"is_complete", "", "as many grasps as were asked for"},
      {"found_share", "1", "grasps over attempts"},
      {"all_contacts_share", "1", "of the grasps, with every requested part in contact"},
      {"penetrating_share", "1", "of the grasps, decided exactly on the true meshes"},
      {"guidance", "", "what the method found in its preparation"}};
  for (const sweep::Column& measure : grasp_measure_columns()) {
    all.push_back({measure.name + "_mean", measure.unit, "mean of: " + measure.meaning});
    all.push_back({measure.name + "_sd", measure.unit, "standard deviation"});
    all.push_back({measure.name + "_median", measure.unit, "median"});
    all.push_back({measure.name + "_count", "1", "grasps that have it"});
  }
  for (sweep::Column& column : planning_columns()) all.push_back(std::move(column));
  return all;
}

std::vector<sweep::Column> timings() {
  std::vector<sweep::Column> all = {
      {"model_s", "s", "object's box tree, patches, voxels and distances, built without the cache"},
      {"scores_s", "s", "its contact scores, which fitting alone needs"},
      {"guidance_s", "s", "the method's own preparation: samples, medial balls"},
      {"per_found_grasp_s", "s",
       "the planner without that preparation over the grasps; failed "
       "attempts included"},
      {"measures_s", "s", "measures beside the planner's own"}};
  for (sweep::Column& column : planning_timings()) all.push_back(std::move(column));
  return all;
}

std::string guidance_text(const grasp::PlannerStatistics& statistics) {
  std::string text;
  for (const auto& [what, count] : statistics.guidance) {
    text += (text.empty() ? "" : "; ") + what + ' ' + std::to_string(count);
  }
  return text;
}

/// Measures the time to build a model without the cache. The time of weak features is in
/// `prepare_s` of a first run.
grasp::ObjectModelTimings uncached_timings(const Planned& planned) {
  const grasp::PlannerOptions& options = planned.settings.options;
  return grasp::build_object_model(planned.object.mesh(), {.resolution = options.resolution,
                                                           .averaging = options.averaging,
                                                           .score = options.score})
      .timings;
}

std::optional<double> share_of(std::size_t count, std::size_t all) {
  if (all == 0) return std::nullopt;
  return static_cast<double>(count) / static_cast<double>(all);
}

/// Smallest value of the distance map over the samples of all links, where the map knows it
/// [voxels].
double d_min(const grasp::ObjectModel& object, const grasp::FittingHand& hand,
             const grasp::Grasp& grasp) {
  constexpr float kEnough = 2.0F;
  const std::vector<geometry::RigidTransform> X_OL =
      hands::forward_kinematics(hand.model(), grasp.configuration);
  float smallest = kEnough;
  for (int link = 0; link < std::ssize(X_OL); ++link) {
    if (hand.samples(link).balls.empty()) continue;
    smallest = std::min(smallest,
                        grasp::smallest_distance(hand, link, X_OL[link], object.distance, kEnough));
  }
  return smallest;
}

/// Rounds a measure for these tables. Plots and statistics would not change with more digits, and
/// the details are half as large.
double to_six_digits(double value) {
  std::array<char, 32> text{};
  const char* const end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6)
          .ptr;
  double rounded = 0.0;
  std::from_chars(text.data(), end, rounded);
  return rounded;
}

std::vector<double> area_shares(const hands::HandModel& hand, const grasp::Grasp& grasp) {
  std::vector<double> shares;
  for (const contact::Contact& contact : grasp.contacts) {
    shares.push_back(contact.area / hands::pad_area(hand.pads[*contact.pad]));
  }
  return shares;
}

std::vector<double> gaps(const grasp::Grasp& grasp) {
  std::vector<double> gaps;
  for (const contact::Contact& contact : grasp.contacts) gaps.push_back(contact.gap);
  return gaps;
}

sweep::CellResult run(const sweep::Cell& cell, const std::filesystem::path& folder) {
  const Planned planned = plan(settings_of(cell));
  std::vector<const grasp::Grasp*> found;  // in the order in which they were found
  for (const grasp::Grasp& grasp : planned.result.grasps) found.push_back(&grasp);
  std::sort(found.begin(), found.end(),
            [](const auto* a, const auto* b) { return a->attempt < b->attempt; });

  sweep::CellResult result{sweep::ResultRow(columns()), sweep::ResultRow(timings())};
  double measures_s = 0.0;
  std::vector<GraspMeasures> measured;
  const grasp::PlannerOptions& options = planned.settings.options;
  const double voxel_size = planned.object.grid.lattice.voxel_size;
  const grasp::FittingHand hand(*planned.hand, options.fitting.sample_spacing * voxel_size);
  for (const grasp::Grasp* grasp : found) {
    measured.push_back(measures_of(planned, *grasp, measures_s));
    sweep::ResultRow row(details());
    row.set("attempt", grasp->attempt);
    row.set("is_valid", grasp->is_valid());
    row.set("has_all_contacts", grasp->has_all_contacts);
    row.set("deepest_overlap_m", grasp::largest_penetration(*grasp));
    row.set("d_min_voxels", d_min(planned.object, hand, *grasp));
    row.set("area_share_median", field(median(area_shares(*planned.hand, *grasp))));
    row.set("gap_median_m", field(median(gaps(*grasp))));
    for (auto& [name, value] : measured.back()) {
      if (value) value = to_six_digits(*value);
      row.set(name, field(value));
    }
    result.details.push_back(std::move(row));
  }

  const auto count_if = [&](auto is) {
    return static_cast<std::size_t>(
        std::count_if(found.begin(), found.end(), [&](const auto* grasp) { return is(*grasp); }));
  };
  sweep::ResultRow& row = result.row;
  fill_planning_columns(planned, row);
  row.set("hand", planned.hand->name);
  row.set("planner_seed", static_cast<std::int64_t>(options.seed));
  row.set("voxel_size_m", voxel_size);
  row.set("clip_thickness_m", grasp::clip_thickness(options, voxel_size));
  row.set("is_complete", std::ssize(found) >= options.count);
  row.set(
      "found_share",
      field(share_of(found.size(), static_cast<std::size_t>(planned.result.statistics.attempts))));
  row.set(
      "all_contacts_share",
      field(share_of(count_if([](const auto& g) { return g.has_all_contacts; }), found.size())));
  row.set("penetrating_share",
          field(share_of(count_if([](const auto& g) { return g.penetration.is_any(); }),
                         found.size())));
  row.set("guidance", guidance_text(planned.result.statistics));
  for (const sweep::Column& measure : grasp_measure_columns()) {
    std::vector<double> values;
    for (const GraspMeasures& measures : measured) {
      if (const auto& value = measures.at(measure.name)) values.push_back(*value);
    }
    row.set(measure.name + "_mean", field(mean(values)));
    row.set(measure.name + "_sd", field(standard_deviation(values)));
    row.set(measure.name + "_median", field(median(values)));
    row.set(measure.name + "_count", field(values.size()));
  }

  fill_planning_timings(planned, result.timings);
  const grasp::ObjectModelTimings model = uncached_timings(planned);
  const double guidance_s = planned.result.timings.guidance_s;
  result.timings.set("model_s",
                     model.query_s + model.patches_s + model.voxels_s + model.distance_s);
  result.timings.set("scores_s", model.scores_s);
  result.timings.set("guidance_s", guidance_s);
  if (!found.empty()) {
    result.timings.set("per_found_grasp_s",
                       (planned.plan_s - guidance_s) / static_cast<double>(found.size()));
  }
  result.timings.set("measures_s", measures_s);
  write_best_grasps(folder, planned, kGraspsKept);
  return result;
}

}  // namespace
}  // namespace method_table_parts

sweep::Experiment method_experiment(const std::string& slug, const MethodTableAxes& axes) {
  using namespace method_table_parts;
  sweep::Experiment experiment;
  experiment.slug = slug;
  experiment.columns = columns();
  experiment.timings = timings();
  experiment.settings = own_settings();
  experiment.details = details();
  experiment.summaries.push_back(
      {"summary", paper_layout_columns(axes),
       [columns = columns(), details = details(), axes](
           const sweep::ParameterSweep& sweep, const std::vector<sweep::FinishedCell>& cells) {
         return paper_layout(columns, details, sweep, cells, axes);
       }});
  experiment.summaries.push_back(
      {"correlations", correlation_columns(axes),
       [columns = details(), axes](const sweep::ParameterSweep& sweep,
                                   const std::vector<sweep::FinishedCell>& cells) {
         return correlations(correlated_measures(), columns, sweep, cells, axes);
       }});
  experiment.check = [](const sweep::Cell& cell) { settings_of(cell); };
  experiment.run = run;
  experiment.inputs = [](const sweep::Cell& cell) { return planning_inputs(settings_of(cell)); };
  return experiment;
}

}  // namespace graspfit::experiments::internal
