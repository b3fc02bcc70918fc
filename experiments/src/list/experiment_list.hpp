#pragma once

#include "graspfit/sweep/experiment.hpp"

/// \file
/// One function per experiment that has a cell of its own, in the source of its name.

namespace graspfit::experiments::internal {

sweep::Experiment candidate_prediction();
sweep::Experiment contacts_and_time();
sweep::Experiment fitting_stages();
sweep::Experiment force_closure();
sweep::Experiment from_table();
sweep::Experiment guidance_models();
sweep::Experiment hold_prediction();
sweep::Experiment hold_rates();
sweep::Experiment parameter_sweeps();
sweep::Experiment reach_grasps();
sweep::Experiment measured_contacts();
sweep::Experiment multidex_objects();
sweep::Experiment object_voxels();
sweep::Experiment special_cases();
sweep::Experiment table_tidying();

}  // namespace graspfit::experiments::internal
