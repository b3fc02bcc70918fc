// Question: of the first valid grasps at targets that the hand can meet, how many close by contacts
// that touch, at which size, with which hand, how near to their targets, and what do they cost?
//
// Answered by one run of the planner per object, size and hand: the columns of the planner's tables
// beside what they do not say, how far contacts are from their targets in the median and which
// parts touch. Met where at least 80 % of the grasps of a hand close and half of the contacts are
// within 10 mm of their targets.

#include <algorithm>
#include <cmath>
#include <functional>

#include "cells/planner_table_experiment.hpp"
#include "graspfit/grasp/grasp.hpp"
#include "list/experiment_list.hpp"

namespace graspfit::experiments::internal {
namespace reach_grasps_parts {
namespace {

void fill(const Planned& planned, sweep::ResultRow& row) {
  const std::vector<grasp::Grasp>& grasps = planned.result.grasps;
  const auto num_with = [&](bool (grasp::Grasp::*has)() const) {
    return field(
        static_cast<std::size_t>(std::count_if(grasps.begin(), grasps.end(), std::mem_fn(has))));
  };
  row.set("friction", planned.settings.options.friction);
  row.set("palm_grasps", num_with(&grasp::Grasp::has_palm_target));
  row.set("behind_tip_grasps", num_with(&grasp::Grasp::has_target_behind_tip));
  std::vector<double> distances;
  for (const grasp::Grasp& grasp : grasps) {
    for (const double distance : grasp::target_distances(grasp)) {
      if (std::isfinite(distance)) distances.push_back(distance);
    }
  }
  row.set("median_target_distance_m", field(median(std::move(distances))));
}

}  // namespace
}  // namespace reach_grasps_parts

sweep::Experiment reach_grasps() {
  return planner_table_experiment(
      "reach_grasps",
      {.columns = {{"friction", "1", "Coulomb's mu of closure and epsilon"},
                   {"palm_grasps", "1", "grasps with a target of the palm"},
                   {"behind_tip_grasps", "1", "grasps with a target of a pad behind a fingertip"},
                   {"median_target_distance_m", "m",
                    "median distance of the contacts from the targets that they were meant for"}},
       .fill = reach_grasps_parts::fill});
}

}  // namespace graspfit::experiments::internal
