#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "graspfit/grasp/grasp_scene.hpp"
#include "graspfit/grasp/hand_fitting.hpp"
#include "graspfit/grasp/planner_options.hpp"
#include "graspfit/hands/hand_configuration.hpp"

/// \file
/// What one planning method does differently from another: where hands start and how they close.
/// Hands, collision guard, refinement, contacts, measures, distinctness, budgets and threads are
/// the planner's and the same for all. A method is a function that makes its `GraspGuidance`, added
/// to `PlanningMethods` by name: a method of this library in `planning_methods`, any other to a
/// copy of them.

namespace graspfit::grasp {

/// What every method is given. All of it outlives the guidance.
struct GuidanceScene : GraspScene {
  const RequestedParts& parts;
  /// Completed by the planner's rules where they leave a value open.
  const PlannerOptions& options;
};

/// One hand about to close on the object.
struct GuidedStart {
  TargetContacts targets = {};  ///< Assigned contacts to reach; empty where a method has none.
  std::function<FittingResult()> close = {};  ///< Brings the hand to the object, by `fit_hand` or
                                              ///< `close_hand` for example. Const and thread-safe.
  /// Where the hand is to be at the targets, perhaps as if there were no object; empty where a
  /// method does not know it.
  std::optional<hands::HandConfiguration> posture = {};
  /// Whether refinement draws the middles of pads toward the targets. Where pads lie at their
  /// targets already, perhaps by an edge, that would move them away again.
  bool draws_to_targets = true;
  /// How firm a grasp with contacts at the targets would be, as `KeptCandidate::Firmest` has it;
  /// empty where a method does not know it.
  std::optional<double> promised_firmness = {};
};

/// Starts of one attempt, the most promising first: they are tried in turn until one of them ends
/// in a grasp that is accepted.
struct GuidedStarts {
  std::vector<GuidedStart> starts = {};  ///< Empty: the attempt fails with `failure`, or there was
                                         ///< nothing left to try.
  std::optional<std::string> failure = {};  ///< Why there is no start, for statistics.
  bool is_exhausted = false;                ///< No later attempt will have starts either.
  std::int64_t seeds_tried = 0;             ///< Work done, for statistics.
  /// Draws further starts of the same attempt, for `PlannerOptions::max_redraws`, with an effort of
  /// at most so many times that of a first draw; the same ones at every call with the same number.
  /// Const and thread-safe; empty where a method has no others.
  std::function<GuidedStarts(double effort)> redraw = {};
};

/// The geometry from which a method derives its starts, as a table of points: its "intermediate
/// model" (paper, Fig. 19).
struct GuidanceModel {
  std::vector<std::string> columns;  ///< x_m, y_m, z_m (in O), then columns of the method's own.
  std::vector<std::vector<double>> rows = {};  ///< One value per column.
};

/// A planning method at work on one object with one hand.
class GraspGuidance {
 public:
  virtual ~GraspGuidance() = default;

  /// The starts of attempt `number`, ≥ 0. They depend on the number alone, not on the order of
  /// attempts or on threads: random numbers are drawn from the stream (seed, number), as may be
  /// those of the preparation.
  virtual GuidedStarts starts(std::int64_t number) const = 0;

  /// Its intermediate model, for pictures.
  virtual GuidanceModel model() const = 0;

  /// All texts that `GuidedStarts::failure` may hold, so that statistics show zero for those that
  /// did not occur. May be empty.
  virtual std::vector<std::string> failures() const { return {}; }

  /// Counts of what the preparation found, by name: "balls on an axis" 312, for example. May be
  /// empty.
  virtual std::map<std::string, std::int64_t> counts() const { return {}; }
};

/// A method that can be asked for by name.
struct PlanningMethod {
  std::string name;   ///< On the command line and in files: "fitting".
  std::string title;  ///< In words.
  std::function<std::unique_ptr<GraspGuidance>(const GuidanceScene&)> make;
  bool has_targets = false;  ///< Its hands are fitted to target contacts.
  bool has_scores = false;   ///< It chooses the target contacts by the score map.
};

/// Methods by name, in the order in which they were added.
class PlanningMethods {
 public:
  /// @throws InvalidInput unless it has a new name, a title and `make`.
  void add(PlanningMethod method);

  std::span<const PlanningMethod> all() const { return methods_; }

  /// @throws InvalidInput that lists the methods, if there is none of that name.
  const PlanningMethod& at(std::string_view name) const;

  /// Null if there is none of that name.
  const PlanningMethod* find(std::string_view name) const;

  /// Their names as "a|b|c".
  std::string names() const;

 private:
  std::vector<PlanningMethod> methods_;
};

/// The methods of this library. To plan by others too, copy it, `add` them, and hand the copy to
/// `plan_grasps` (`PlanningRun::methods`).
const PlanningMethods& planning_methods();

/// A model as CSV with a header line, numbers in their shortest round-trip form.
std::string to_csv(const GuidanceModel& model);

/// A model as an ASCII PLY file of points, one property per column, for ParaView and MeshLab: x_m,
/// y_m, z_m are called x, y, z there, other columns as they are (nx, ny, nz are normals).
std::string to_ply(const GuidanceModel& model);

}  // namespace graspfit::grasp
