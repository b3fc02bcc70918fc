// Question: on the paper's 22 objects, how often does an attempt of the planner end in a grasp that
// is usable (M > 0) or valid (also: touches with every part asked for, penetrates nothing, has a
// way in), how good are these grasps, and at which stage do the others fail?
//
// Answered by one row per object and grip. Ten or more in `grasps` on at least 18 objects for the
// Barrett hand, gaps of at most 0.1 mm and no penetration in any row would be what is aimed at.
#include "internal/experiment_list.hpp"
#include "internal/planner_table_experiment.hpp"

namespace graspfit::experiments::internal {

Experiment planner_paper_objects() { return planner_table_experiment("planner_paper_objects"); }

}  // namespace graspfit::experiments::internal
