#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "graspfit/base/content_cache.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/motion/table_motion.hpp"

namespace graspfit::motion {

/// How an object is picked up and put down. The paper's table tidying (Fig. 20) plans each grasp
/// for an approach direction and interpolates; the requirement that nothing is touched during the
/// motion is ours [R].
struct PickAndPlaceOptions {
  /// `count` grasps are tried per approach, best first; acceptance must be Valid with pre-grasps.
  /// `approach_O` is set here, and pre-grasps are fully open (`pre_grasp.opening_steps` 1).
  grasp::PlannerOptions planner;
  hands::HandConfiguration home;  ///< Where every move begins and ends; `X_OH` is X_WH.
  /// Wanted palm directions in W, tried in order until a grasp can be used; their lengths, > 0, do
  /// not matter. If empty, they are the direction from the palm center at home to the object's
  /// center of mass [P: "from the hand's initial pose toward the object's initial pose"], where
  /// these points differ, then straight down.
  std::vector<Eigen::Vector3d> approaches_W;
  double clearance = 0.003;  ///< Clearance of hand and carried object from everything else while
                             ///< they travel [m], ≥ 0 and below `planner.pre_grasp.clearance`.
  std::vector<double> lifts = {0.08, 0.16, 0.26};       ///< Heights to lift by, tried in order [m].
  std::vector<double> withdrawals = {0.06, 0.12, 0.2};  ///< Distances by which the palm withdraws
                                                        ///< from the pre-grasp, against its
                                                        ///< direction, tried in order [m].
  base::ContentCache cache = {.is_on = false};          ///< Cache of objects prepared before.
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// A move of one object, from home to home, that was found free of collisions.
struct PlannedMove {
  int object = -1;
  geometry::RigidTransform X_WO_from = geometry::RigidTransform::Identity();
  geometry::RigidTransform X_WO_to = geometry::RigidTransform::Identity();
  grasp::Grasp grasp;  ///< Grasp in the frame in which it was planned: W, with the object at
                       ///< X_WO_from.
  Eigen::Vector3d approach_W = Eigen::Vector3d::Zero();  ///< Wanted palm direction, unit.
  std::vector<MotionSegment> segments;                   ///< Each begins where the last one ends.
  std::int64_t planner_attempts = 0;  ///< Effort of finding the move, as in MoveAttempt.
  int grasps_tried = 0;
  int segments_tried = 0;
  std::string refusals;  ///< Why earlier grasps and paths were refused, in one line.
};

/// What became of the attempt to move an object.
struct MoveAttempt {
  std::optional<PlannedMove> move;  ///< Move that was found; empty if it is impossible within the
                                    ///< options' limits.
  std::int64_t planner_attempts = 0;
  int grasps_tried = 0;
  int segments_tried = 0;
  /// Reasons for which grasps and paths were refused, with how often: "lift: bunny and mug", "no
  /// valid grasp with room at start and goal in …".
  std::map<std::string, int> failures;
  /// The most frequent reasons in a line; of equally frequent ones the first by name.
  std::string reason() const;
};

/// Plans the move of an object from where it stands (`X_WO[object]`, the others around it) to
/// `X_WO_goal`: reach, approach, lift, transport and turn, place, release, retreat. Every segment
/// is proven free of collisions (`find_collision`).
///
/// Grasps are planned in W on the object as it stands. They avoid the table and the convex hulls of
/// the other objects, both where these are now and where they are relative to the object at its
/// goal, so that the hand has clearance at both ends. The motion is then proven on the true meshes.
/// Taken is the best grasp that can be carried along a tried path, for the first approach direction
/// with such a grasp. On these paths the object goes straight up by one of `lifts`, then straight
/// to above its goal (turning on the way, or before, or after it), then straight down; the free
/// hand comes and goes through points behind the pre-grasp (`withdrawals`) and above those. The
/// result is deterministic in the input.
///
/// If the object is too large or too small for the hand, by its bounding box in its own frame
/// however it stands, this is the attempt's reason. @throws InvalidInput for bad options and an
/// object that is not there; else as `plan_grasps`.
MoveAttempt plan_move(const TableScene& scene, std::span<const geometry::RigidTransform> X_WO,
                      int object, const geometry::RigidTransform& X_WO_goal,
                      const PickAndPlaceOptions& options);

}  // namespace graspfit::motion
