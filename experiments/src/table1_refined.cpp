// Question: does the order of table1 hold for grasps that one could use: contacts made real on the
// true meshes, nothing penetrating, a way in?
//
// Answered as table1, with refinement for all methods alike, counting valid grasps.
#include "internal/experiment_list.hpp"
#include "internal/method_table.hpp"

namespace graspfit::experiments::internal {

Experiment table1_refined() { return method_experiment("table1_refined"); }

}  // namespace graspfit::experiments::internal
