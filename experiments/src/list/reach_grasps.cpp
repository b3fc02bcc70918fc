// Question: of the first valid grasps at targets that the hand can meet, how many close by contacts
// that touch, at which size, with which hand, how near to their targets, and what do they cost?
//
// Answered by one run of the planner per object, size and hand: the columns of the planner's tables
// beside what they do not say, how far contacts are from their targets in the median and which
// parts touch. Met where at least 80 % of the grasps of a hand close and half of the contacts are
// within 10 mm of their targets.

#include <algorithm>
#include <cmath>

#include "cells/planning_table.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/grasp/grasp.hpp"
#include "list/experiment_list.hpp"

namespace graspfit::experiments::internal {
namespace reach_grasps_parts {
namespace {

constexpr std::size_t kGraspsKept = 10;  // per cell

std::vector<sweep::Column> columns() {
  std::vector<sweep::Column> all = {
      {"friction", "1", "Coulomb's mu of closure and epsilon"},
      {"palm_grasps", "1", "grasps with a target of the palm"},
      {"behind_tip_grasps", "1", "grasps with a target of a pad behind a fingertip"},
      {"median_target_distance_m", "m",
       "median distance of the contacts from the targets that they were meant for"}};
  for (sweep::Column& column : planning_columns()) all.push_back(std::move(column));
  return all;
}

/// Grasps that have a target of which `is_meant` is true.
template <class IsMeant>
std::int64_t num_with_target(const std::vector<grasp::Grasp>& grasps, const IsMeant& is_meant) {
  return std::count_if(grasps.begin(), grasps.end(), [&](const grasp::Grasp& grasp) {
    const std::vector<grasp::TargetContact>& targets = grasp.targets.contacts;
    return std::any_of(targets.begin(), targets.end(), is_meant);
  });
}

sweep::CellResult run(const sweep::Cell& cell, const std::filesystem::path& folder) {
  const Planned planned = plan(planning_settings(cell));
  const std::vector<grasp::Grasp>& grasps = planned.result.grasps;
  sweep::CellResult result{sweep::ResultRow(columns()), sweep::ResultRow(planning_timings())};
  result.row.set("friction", planned.settings.options.friction);
  result.row.set("palm_grasps", num_with_target(grasps, [](const grasp::TargetContact& target) {
                   return target.is_palm;
                 }));
  result.row.set("behind_tip_grasps",
                 num_with_target(grasps, [](const grasp::TargetContact& target) {
                   return target.pad.has_value();
                 }));
  std::vector<double> distances;
  for (const grasp::Grasp& grasp : grasps) {
    for (const double distance : grasp::target_distances(grasp)) {
      if (std::isfinite(distance)) distances.push_back(distance);
    }
  }
  result.row.set("median_target_distance_m", field(median(std::move(distances))));
  fill_planning_columns(planned, result.row);
  fill_planning_timings(planned, result.timings);
  write_best_grasps(folder, planned, kGraspsKept);
  return result;
}

}  // namespace
}  // namespace reach_grasps_parts

sweep::Experiment reach_grasps() {
  using namespace reach_grasps_parts;
  return {
      .slug = "reach_grasps",
      .columns = columns(),
      .timings = planning_timings(),
      .check = [](const sweep::Cell& cell) { planning_settings(cell); },
      .run = run,
      .inputs = [](const sweep::Cell& cell) { return planning_inputs(planning_settings(cell)); }};
}

}  // namespace graspfit::experiments::internal
