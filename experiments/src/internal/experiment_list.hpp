#pragma once

#include "graspfit/experiments/experiment.hpp"

/// \file
/// One function per experiment, in the source of its name.

namespace graspfit::experiments::internal {

Experiment contacts_and_time();
Experiment fitting_stages();
Experiment force_closure();
Experiment guidance_models();
Experiment hold_choices();
Experiment hold_prediction();
Experiment hold_rates();
Experiment parameter_sweeps();
Experiment measured_contacts();
Experiment object_voxels();
Experiment paper_grasps();
Experiment planner_everyday();
Experiment planner_paper_objects();
Experiment special_cases();
Experiment table1();
Experiment table1_all_objects();
Experiment table1_readings();
Experiment table1_refined();
Experiment table_tidying();

}  // namespace graspfit::experiments::internal
