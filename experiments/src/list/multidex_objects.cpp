// Question: how many attempts end in a grasp that holds, on the objects on which learned methods
// report success (the ten test objects of MultiDex, at their own sizes), under their test and under
// harder ones?
//
// Answered by one row per object and hand: all attempts are made and count, every valid grasp is
// tested under D(R,O)'s test, DexGraspBench's and Dexonomy's hard one. What is asked is that the
// mean over the hands is above the best published one under `dro` (0.948, T(R,O)) and above 0.85
// under `dexgraspbench-100g`.
#include "cells/hold_cell.hpp"
#include "cells/planning_table.hpp"
#include "graspfit/grasp/grasp_diversity.hpp"
#include "list/experiment_list.hpp"

namespace graspfit::experiments::internal {
namespace multidex_objects_parts {
namespace {

void fill(const Planned& planned, sweep::ResultRow& row) {
  std::vector<hands::HandConfiguration> configurations;
  for (const grasp::Grasp& grasp : planned.result.grasps) {
    configurations.push_back(grasp.configuration);
  }
  const grasp::GraspDiversity diversity = grasp::grasp_diversity(*planned.hand, configurations);
  row.set("clusters", std::int64_t{diversity.num_clusters});
  row.set("first_axis_share", field(diversity.first_axis_share));
}

}  // namespace
}  // namespace multidex_objects_parts

sweep::Experiment multidex_objects() {
  return hold_experiment(
      "multidex_objects", kMultidexProtocols,
      {.columns = {{"clusters", "1",
                    "of grasps linked by less than 10 mm, 15 degrees and 0.2 rad of each joint"},
                   {"first_axis_share", "1",
                    "of the grasps' variance, along its first principal axis"}},
       .fill = multidex_objects_parts::fill});
}

}  // namespace graspfit::experiments::internal
