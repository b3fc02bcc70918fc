#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "graspfit/motion/pick_and_place.hpp"

namespace graspfit::motion {

/// How a table is tidied.
struct TidyingOptions {
  PickAndPlaceOptions move;
  /// Points of the table where an object may be put down in between, vertically under its center of
  /// mass [m, in W]: to be grasped anew, or to make room for others. If empty, every object goes to
  /// its goal in one move.
  std::vector<Eigen::Vector2d> resting_places_W;
  int max_rest_poses = 3;    ///< Rest poses that are tried at each of these points, ≥ 1.
  int max_moves_tried = 60;  ///< Moves planned in all, failures included, ≥ 1.
  void validate() const;     ///< Throws InvalidInput naming the field and its value.
};

/// An object that stays short of its goal.
struct UnmovedObject {
  int object = -1;
  std::string reason;  ///< Why its move to the goal failed, in the best arrangement reached.
};

/// What came of tidying a table.
struct TidyingResult {
  std::vector<geometry::RigidTransform> X_WO_start;
  std::vector<geometry::RigidTransform> X_WO_end;  ///< Final poses; of objects that reached their
                                                   ///< goals these, bit for bit.
  std::vector<PlannedMove> moves;                  ///< In the order in which they are made.
  std::vector<UnmovedObject> unmoved;              ///< Objects that stay short of their goals;
                                                   ///< empty: the table is tidy.
  int moves_tried = 0;
  int segments_tried = 0;
  std::int64_t planner_attempts = 0;
  int grasps_tried = 0;
};

/// Finds an order of moves that brings every object from `X_WO_start` to `X_WO_goal`, each proven
/// free of collisions (`plan_move`). An object whose two poses are equal stays.
///
/// The search is depth first, with objects in their order. Where no remaining object can go to its
/// goal, one of them is put down at a resting place in between (each object once): with the side up
/// that is up at its goal, with the side up that was up before, or in another of its rest poses,
/// each in quarter turns. If not all goals are reached within `max_moves_tried`, the result is the
/// longest sequence found (most objects at their goals), with the reason for each object that
/// stays. So an empty `unmoved` is a proof that the goals can be reached, while objects in it prove
/// nothing. A move that was refused before in the same arrangement is not planned again, but counts
/// as if it were.
/// @throws InvalidInput for bad options, different numbers of poses, objects that start inside each
/// other, and a start or goal inside the table (deeper than 1e-9 m).
TidyingResult tidy_table(const TableScene& scene,
                         const std::vector<geometry::RigidTransform>& X_WO_start,
                         const std::vector<geometry::RigidTransform>& X_WO_goal,
                         const TidyingOptions& options);

}  // namespace graspfit::motion
