// Question: how do the time of a grasp and its quality depend on the number of its contacts N', and
// which part of M is it that grows?
//
// Answered by a row per object and grip with means over its usable grasps, their times by N' apart,
// and a row per grasp in the details. The paper's curves say that time jumps from three contacts to
// four and more, and that M grows with N' because more contacts make more stable pairs.
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "cells/planning_table.hpp"
#include "graspfit/base/as_index.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "list/experiment_list.hpp"

namespace graspfit::experiments::internal {
namespace contacts_and_time_parts {
namespace {

/// Numbers of contacts N' with a column of their own among the timings; the last one stands for
/// more, too.
constexpr std::array kContactCounts = {2, 3, 4, 5, 6, 7};

std::vector<sweep::Column> columns() {
  return {{"object_extent_m", "m", "longest edge of the object's bounding box"},
          {"requested", "1", "N: fingers and palm that must touch"},
          {"attempts", "1", "target sets fitted"},
          {"usable", "1", "attempts that ended in a grasp with M > 0"},
          {"grasps", "1", "usable grasps, alike ones too; the following are about these"},
          {"mean_num_contacts", "1", "mean N'"},
          {"mean_stable_pairs", "1", "mean number of stable pairs"},
          {"mean_m", "1", "mean M"},
          {"mean_m1", "1", "mean M1"},
          {"mean_m2", "1", "mean M2"},
          {"mean_m3", "1", "mean M3"}};
}

std::vector<sweep::Column> details() {
  return {{"attempt", "1", "number of the attempt that made the grasp"},
          {"num_contacts", "1", "N'"},
          {"stable_pairs", "1", "m"},
          {"m", "1", "M"},
          {"m1", "1", "M1"},
          {"m2", "1", "M2"},
          {"m3", "1", "M3"}};
}

std::string count_name(int count) {
  return std::to_string(count) + (count == kContactCounts.back() ? "_or_more" : "");
}

std::vector<sweep::Column> timings() {
  std::vector<sweep::Column> all;
  for (const int count : kContactCounts) {
    const std::string contacts = count_name(count);
    all.push_back({"cpu_s_" + contacts, "s",
                   "mean processor time of the attempts whose grasps have so many contacts"});
    all.push_back({"grasps_" + contacts, "1", "grasps that this is the mean of"});
  }
  all.push_back({"cpu_per_usable_s", "s", "processor time over usable grasps, failures included"});
  for (sweep::Column& column : planning_timings()) all.push_back(std::move(column));
  return all;
}

/// Reads the settings, which must keep all usable grasps: a selection by M would have more contacts
/// than chance gives.
PlanningSettings settings_of(const sweep::Cell& cell) {
  PlanningSettings settings = planning_settings(cell);
  if (settings.options.count < settings.options.max_attempts) {
    throw sweep::SettingError("count",
                              "must be at least max-attempts: fewer would be selected by M");
  }
  if (settings.options.search != grasp::SearchRule::Best) {
    throw sweep::SettingError("search", "must be best: all attempts are made");
  }
  const grasp::DistinctOptions& alike = settings.options.distinct;
  if (alike.translation > 0.0 || alike.rotation > 0.0 || alike.joints > 0.0) {
    throw sweep::SettingError(
        "distinct-translation-mm",
        "must be 0, as distinct-rotation-deg and distinct-joints: of grasps that are "
        "alike the one with the larger M would stay");
  }
  return settings;
}

void fill_timings(const Planned& planned, sweep::ResultRow& row) {
  std::map<int, std::vector<double>> cpu_s;
  for (const grasp::Grasp& grasp : planned.result.grasps) {
    const auto attempt = static_cast<std::size_t>(grasp.attempt);
    if (attempt >= planned.attempt_cpu_s.size()) continue;
    const double before = attempt == 0 ? 0.0 : planned.attempt_cpu_s[attempt - 1];
    const int count = std::min(base::as_index<int>(grasp.contacts.size()), kContactCounts.back());
    cpu_s[count].push_back(planned.attempt_cpu_s[attempt] - before);
  }
  for (const int count : kContactCounts) {
    row.set("cpu_s_" + count_name(count), field(mean(cpu_s[count])));
    row.set("grasps_" + count_name(count), field(cpu_s[count].size()));
  }
  const std::int64_t usable = planned.result.statistics.usable();
  if (usable > 0 && !planned.attempt_cpu_s.empty()) {
    row.set("cpu_per_usable_s", planned.attempt_cpu_s.back() / static_cast<double>(usable));
  }
  fill_planning_timings(planned, row);
}

sweep::CellResult run(const sweep::Cell& cell, const std::filesystem::path& folder) {
  const Planned planned = plan(settings_of(cell));
  sweep::CellResult result{sweep::ResultRow(columns()), sweep::ResultRow(timings())};
  std::map<std::string, std::vector<double>> values;
  for (const grasp::Grasp& grasp : planned.result.grasps) {
    const std::map<std::string, double> numbers = {
        {"num_contacts", static_cast<double>(grasp.contacts.size())},
        {"stable_pairs", static_cast<double>(grasp.quality.stable_pairs.size())},
        {"m", grasp.quality.m},
        {"m1", grasp.quality.m1},
        {"m2", grasp.quality.m2},
        {"m3", grasp.quality.m3}};
    sweep::ResultRow detail(details());
    detail.set("attempt", grasp.attempt);
    for (const auto& [name, value] : numbers) {
      detail.set(name, value);
      values[name].push_back(value);
    }
    result.details.push_back(std::move(detail));
  }
  const grasp::PlannerStatistics& statistics = planned.result.statistics;
  result.row.set("object_extent_m", geometry::longest_extent(planned.object_file->mesh));
  result.row.set(
      "requested",
      std::int64_t{grasp::requested_parts(*planned.hand, planned.settings.options).size()});
  result.row.set("attempts", statistics.attempts);
  result.row.set("usable", statistics.usable());
  result.row.set("grasps", field(planned.result.grasps.size()));
  for (const sweep::Column& column : details()) {
    if (column.name != "attempt") {
      result.row.set("mean_" + column.name, field(mean(values[column.name])));
    }
  }
  fill_timings(planned, result.timings);
  write_best_grasps(folder, planned, 1);
  return result;
}

}  // namespace
}  // namespace contacts_and_time_parts

sweep::Experiment contacts_and_time() {
  using namespace contacts_and_time_parts;
  return {.slug = "contacts_and_time",
          .columns = columns(),
          .timings = timings(),
          .details = details(),
          .check = [](const sweep::Cell& cell) { settings_of(cell); },
          .run = run,
          .inputs = [](const sweep::Cell& cell) { return planning_inputs(settings_of(cell)); }};
}

}  // namespace graspfit::experiments::internal
