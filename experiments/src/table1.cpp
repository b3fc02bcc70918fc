// Question: is the paper's Table 1 right that hand-object fitting finds grasps of a larger M than
// the medial axis (MA), and that than sampled surface normals (GS), on every object, in comparable
// time?
//
// Answered by one row per object, size and method: the first 100 attempts that end with M > 0, at
// the level of voxels and with nothing selected (A36 off), their mean M and every other measure,
// and the time per grasp with failed attempts counted. The summary puts the mean M of the methods
// beside the paper's; the paper's order is fitting > ma > gs. The table `correlations` says how
// much M agrees with other measures on which grasps are better.
#include "internal/experiment_list.hpp"
#include "internal/method_table.hpp"

namespace graspfit::experiments::internal {

Experiment table1() { return method_experiment("table1"); }

}  // namespace graspfit::experiments::internal
