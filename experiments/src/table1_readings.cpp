// Question: would Table 1, and how far M agrees with other measures, look different if what the
// paper leaves open about M were read in another way?
//
// Answered as table1 at one size, once per reading. Readings of M alone find the same grasps, but
// for those with M > 0; `plain` and `no_weak` change the score map, and so targets, too. The
// summary shows the order of methods under each reading, `correlations` how the readings' M agrees
// with the other measures.
#include "internal/experiment_list.hpp"
#include "internal/method_table.hpp"

namespace graspfit::experiments::internal {

Experiment table1_readings() {
  return method_experiment("table1_readings", {.row = "reading", .group = "reading"});
}

}  // namespace graspfit::experiments::internal
