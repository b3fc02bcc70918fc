// Question: does the order of table1 hold on all of the paper's objects that are closed?
//
// Answered as table1, with fewer grasps per object and one size.
#include "internal/experiment_list.hpp"
#include "internal/method_table.hpp"

namespace graspfit::experiments::internal {

Experiment table1_all_objects() { return method_experiment("table1_all_objects"); }

}  // namespace graspfit::experiments::internal
