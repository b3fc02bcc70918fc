#pragma once

#include <optional>

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/grasp/surroundings.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::grasp {

/// What a pre-grasp must keep.
struct PreGraspOptions {
  double clearance = 0.005;      ///< Every link from the object and the surroundings [m], > 0.
  double largest_retreat = 0.1;  ///< Of the palm, against its direction [m], ≥ 0.
  double retreat_step = 0.01;    ///< [m], > 0.
  int opening_steps = 10;        ///< From the grasp's joints to open ones, ≥ 1.
  double way_tolerance = 1e-5;   ///< On the way, links may come this near before the grasp is
                                 ///< reached [m], > 0: what is closer is not told from touching.
  void validate() const;         ///< Throws InvalidInput naming the field and its value.
};

/// Where to start from (evaluation of grasps in the field: pre-grasp, grasp, squeeze).
struct PreGrasp {
  hands::HandConfiguration configuration;
  double clearance = 0.0;  ///< Of the nearest link [m], ≥ the wanted one.
  double opening = 0.0;    ///< Share of the way from the grasp's joints to the open ones.
  double retreat = 0.0;    ///< Of the palm, against its direction [m].
};

/// Poses on the straight way from one configuration to another: palm position linear, its rotation
/// along the shortest arc, joints linear; share 0 is `from`.
hands::HandConfiguration interpolated(const hands::HandConfiguration& from,
                                      const hands::HandConfiguration& to, double share);

/// The least opening, and for it the least retreat, from which the hand is clear of object and
/// surroundings by `clearance` and can go straight to the grasp without touching them on the way,
/// nor itself more than the grasp does.
///
/// That the way is free is proven, not sampled: each step is bounded by the distance left over the
/// speed of the fastest point (conservative advancement), up to within `way_tolerance` of the end,
/// where bodies that the grasp itself holds apart by less may be nearer. Empty if there is none.
std::optional<PreGrasp> find_pre_grasp(const hands::HandModel& hand,
                                       const hands::HandCollision& collision,
                                       const geometry::MeshQuery& object,
                                       const SurroundingsCollision& surroundings,
                                       const hands::HandConfiguration& grasp,
                                       const PreGraspOptions& options = {});

}  // namespace graspfit::grasp
