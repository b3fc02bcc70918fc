#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "graspfit/grasp/grasp_guidance.hpp"
#include "graspfit/grasp/object_model.hpp"
#include "graspfit/grasp/planner_options.hpp"
#include "graspfit/grasp/planner_result.hpp"
#include "graspfit/grasp/surroundings.hpp"

namespace graspfit::grasp {

/// Called after each attempt with (attempts done, grasps found); may be empty.
using PlannerProgress = std::function<void(std::int64_t, std::int64_t)>;

/// How a run goes about its work. But for a stop, and the wall-clock limit of its options, no
/// result depends on it.
struct PlanningRun {
  int num_threads = 0;            ///< Attempts at once; 0: as many as the machine has.
  PlannerProgress progress = {};  ///< Called by one thread at a time.
  std::stop_token stop = {};      ///< Once requested no further attempt begins; those under way are
                                  ///< finished and count.
  const PlanningMethods& methods = planning_methods();  ///< Among which `options.planner` is.
};

/// Why `hand` could not hold an object in any pose, with its extents along the axes of the mesh's
/// own frame, and what to do: it is smaller than a fingertip, or thicker in every direction than
/// the parts of the hand that `options` ask for open. Empty: it may be held.
std::optional<std::string> size_refusal(const geometry::TriangleMesh& mesh,
                                        const hands::HandModel& hand,
                                        const PlannerOptions& options);

/// The object prepared as `options` ask for. With a cache as `cached_object_model`: the same model,
/// sooner. @throws InvalidInput for options out of range.
ObjectModel prepare_object(const geometry::TriangleMesh& mesh, const PlannerOptions& options,
                           ObjectModelTimings* timings = nullptr,
                           const base::ContentCache& cache = {.is_on = false});

/// The same, for an object in its own frame and a hand that is to hold it; the model is good for
/// every hand. @throws InvalidInput also with `size_refusal`, if there is one.
ObjectModel prepare_object(const geometry::TriangleMesh& mesh, const hands::HandModel& hand,
                           const PlannerOptions& options, ObjectModelTimings* timings = nullptr,
                           const base::ContentCache& cache = {.is_on = false});

/// Attempts by the method `options.planner`, until `count` grasps are accepted or the budget is
/// used. Of hand-object geometric fitting (paper section 11): target contacts, fitting, contacts,
/// measure. Whether the object has a size that the hand can hold was asked before
/// (`prepare_object`, `size_refusal`): here the answer is that no attempt succeeds.
///
/// @throws InvalidInput for options that the hand cannot meet (unknown finger, more contacts than
/// it allows).
PlannerResult plan_grasps(const ObjectModel& object, const hands::HandModel& hand,
                          const PlannerOptions& options, const Surroundings& surroundings = {},
                          const PlanningRun& run = {});

/// The intermediate model of the method that `options` name. @throws as `plan_grasps`.
GuidanceModel guidance_model(const ObjectModel& object, const hands::HandModel& hand,
                             const PlannerOptions& options, const Surroundings& surroundings = {});

}  // namespace graspfit::grasp
