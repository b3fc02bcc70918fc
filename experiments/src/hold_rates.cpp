// Question: do the planner's grasps hold in a physics engine, per attempt and per returned grasp,
// under the protocols by which others judge theirs (DexGraspBench's with 100 g, Dexonomy's hard
// mode, MultiDex's with 0.05 g), and where are the others lost?
//
// Answered by one row per object and grip (a hand in precision or power): all attempts are counted,
// every valid grasp is tested, and nothing is filtered by the simulator. What others publish was
// found on other objects; what is aimed at is Allegro precision above 0.605 per attempt (hard mode
// 0.272), Shadow or human power above 0.242, and under MultiDex's protocol Barrett above 0.881 and
// Allegro above 0.932.
#include "internal/experiment_list.hpp"
#include "internal/hold_cell.hpp"

namespace graspfit::experiments::internal {

Experiment hold_rates() { return hold_experiment("hold_rates"); }

}  // namespace graspfit::experiments::internal
