// Question: does the planner carry over to everyday objects and to hands that it was not made with:
// the shipped gripper, Barrett and human hands, and Allegro and Shadow hands as others publish
// them?
//
// Answered by one row per object and hand, with the columns of planner_paper_objects: a hand that
// is carried over well has valid grasps on the objects that fit it.
#include "internal/experiment_list.hpp"
#include "internal/planner_table_experiment.hpp"

namespace graspfit::experiments::internal {

Experiment planner_everyday() { return planner_table_experiment("planner_everyday"); }

}  // namespace graspfit::experiments::internal
