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

/// A start of an attempt that was tried, and what became of it.
struct TriedStart {
  std::int64_t attempt = 0;
  const GuidedStart& start;
  /// As of an attempt that had no other start, except that no way in was looked for: `Valid` may
  /// yet be `NoWayIn`.
  AttemptOutcome outcome = AttemptOutcome::NoTargets;
  /// Its grasp; null unless the outcome is `Valid` or `UsableOnly`.
  const Grasp* grasp = nullptr;
};

/// Called for every start that was tried, in their order within an attempt; attempts of several
/// threads call it at once. What it is given lasts until it returns.
using TriedStartObserver = std::function<void(const TriedStart&)>;

/// How a run is carried out. Except for a requested stop, other `methods` and the wall-clock limit
/// of the options, no result depends on it.
struct PlanningRun {
  int num_threads = 0;            ///< Attempts at once; 0: as many as the machine has.
  PlannerProgress progress = {};  ///< Called by one thread at a time.
  std::stop_token stop = {};      ///< Once requested no further attempt begins; those under way are
                                  ///< finished and count.
  /// The methods that `options.planner` is one of.
  const PlanningMethods& methods = planning_methods();
  TriedStartObserver tried_start = {};  ///< To look at what attempts do; may be empty.
};

/// Why `hand` could not hold the object in any pose: along every axis of the mesh's own frame the
/// object is smaller than the widest requested fingertip pad, or thicker than the requested parts
/// of the hand can open. The text states the object's extents along these axes, and what to do.
/// Empty: the object may be held. @throws InvalidInput for options that the hand cannot meet.
std::optional<std::string> size_refusal(const geometry::TriangleMesh& mesh,
                                        const hands::HandModel& hand,
                                        const PlannerOptions& options);

/// The object prepared as `options` ask for. With a cache as `cached_object_model`: the same model,
/// sooner. @throws InvalidInput for options out of range.
ObjectModel prepare_object(const geometry::TriangleMesh& mesh, const PlannerOptions& options,
                           const base::ContentCache& cache = {.is_on = false});

/// The same, for an object in its own frame and a hand that is to hold it; the model is good for
/// every hand. @throws InvalidInput also with `size_refusal`, if there is one.
ObjectModel prepare_object(const geometry::TriangleMesh& mesh, const hands::HandModel& hand,
                           const PlannerOptions& options,
                           const base::ContentCache& cache = {.is_on = false});

/// Makes attempts by the method `options.planner` until `count` grasps are accepted
/// (`SearchRule::First`; `Closed`: and close) or the budget is used. An attempt of hand-object
/// geometric fitting (paper section 11) selects target contacts, fits the hand, estimates contacts
/// and measures the grasp. The object's size is not checked here (`prepare_object` and
/// `size_refusal` do so): with an object that the hand cannot hold no attempt succeeds.
///
/// @throws InvalidInput for options that the hand cannot meet (unknown finger, more contacts than
/// it allows).
PlannerResult plan_grasps(const ObjectModel& object, const hands::HandModel& hand,
                          const PlannerOptions& options, const Surroundings& surroundings = {},
                          const PlanningRun& run = {});

/// The intermediate model of the method that `options` name. @throws as `plan_grasps`.
GuidanceModel guidance_model(const ObjectModel& object, const hands::HandModel& hand,
                             const PlannerOptions& options, const Surroundings& surroundings = {});

/// Calls `visit` with the starts of the attempts 0 to `num_attempts` − 1, none of which is tried,
/// in their order. What it is given lasts until it returns. @throws as `plan_grasps`.
void visit_starts(const ObjectModel& object, const hands::HandModel& hand,
                  const PlannerOptions& options, std::int64_t num_attempts,
                  const std::function<void(const GuidedStart&)>& visit,
                  const Surroundings& surroundings = {});

}  // namespace graspfit::grasp
