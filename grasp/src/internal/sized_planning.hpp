#pragma once

#include "graspfit/grasp/grasp_planner.hpp"

/// \file
/// Planning on an object whose size was checked elsewhere. The check compares the box around a mesh
/// with the hand, and so is good for a mesh in its own frame only: seen from W, an object that
/// stands turned has a larger box.

namespace graspfit::grasp::internal {

/// `prepare_object` without the check of the size; `options` are valid.
ObjectModel prepare_sized_object(const geometry::TriangleMesh& mesh, const PlannerOptions& options,
                                 ObjectModelTimings* timings, const geometry::ContentCache& cache);

/// `plan_grasps` without the check of the size.
PlannerResult plan_sized_grasps(const ObjectModel& object, const hands::HandModel& hand,
                                const PlannerOptions& options, const Surroundings& surroundings,
                                int num_threads);

}  // namespace graspfit::grasp::internal
