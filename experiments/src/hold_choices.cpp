// Question: what do attempts gain, in grasps found and in grasps that hold, by preferring squeezes
// that balance, by keeping the strongest of several grasps, and by a fourth finger?
//
// Answered by the rows of hold_rates (one per object and grip) for each way to choose among the
// starts of an attempt. What a choice costs is in the timings: attempts that keep the strongest
// grasp fit every start that they have.
#include "internal/experiment_list.hpp"
#include "internal/hold_cell.hpp"

namespace graspfit::experiments::internal {

Experiment hold_choices() { return hold_experiment("hold_choices"); }

}  // namespace graspfit::experiments::internal
