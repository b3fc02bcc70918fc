// Question: what do the grasps look like that the paper shows: of fifteen objects with three hands,
// of one object at three sizes and from three sides, of a small and a large torus, of a ball in
// four modes, of objects that its method fails on?
//
// Answered by a row per picture, with the columns of planner_paper_objects, and by the grasp file
// of its cell: the pictures are drawn from these.
#include "internal/experiment_list.hpp"
#include "internal/planner_table_experiment.hpp"

namespace graspfit::experiments::internal {

Experiment paper_grasps() { return planner_table_experiment("paper_grasps"); }

}  // namespace graspfit::experiments::internal
