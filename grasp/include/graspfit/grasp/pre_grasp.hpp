#pragma once

#include <optional>

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/grasp/surroundings.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::grasp {

/// The hand, the object and the surroundings among which the hand moves to a grasp. The scene
/// refers to all of them and owns none.
struct PreGraspScene {
  const hands::HandModel& hand;
  const hands::HandCollision& collision;  ///< Of the same hand.
  const geometry::MeshQuery& object;
  const SurroundingsCollision& surroundings;  ///< Of the same hand.
};

/// Requirements of a pre-grasp, and limits of the search for one.
struct PreGraspOptions {
  double clearance = 0.005;      ///< Every link from the object and the surroundings [m], > 0.
  double largest_retreat = 0.1;  ///< Of the palm, against its direction [m], in [0, 10].
  double retreat_step = 0.01;    ///< [m], > 0; at most 1000 of them up to `largest_retreat`.
  int opening_steps = 10;        ///< From the grasp's joints to open ones, in [1, 1000].
  /// Whether neutral joints (spread, abduction) may open, too, where no pre-grasp is found without:
  /// fingers that a grasp draws together around an object would cross each other as they
  /// straighten.
  bool open_neutral = false;
  /// Whether joints may stay, where no pre-grasp is found by opening them, whose opening moves what
  /// touches the object further onto it, as that of a thumb that lies across the object may.
  bool leave_pressing = false;
  /// Length of the end of the path over which bodies that touch in the grasp, or nearly do, may
  /// already touch [m], > 0; the default is half of the gap that refinement leaves.
  double way_tolerance = 1e-5;
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// The configuration from which the hand moves to a grasp (evaluation of grasps in the field:
/// pre-grasp, grasp, squeeze).
struct PreGrasp {
  hands::HandConfiguration configuration;
  double clearance = 0.0;  ///< Distance of the nearest link [m], ≥ the wanted clearance.
  /// Share of the motion from the grasp's joint positions to the open ones, in [0, 1]; 0 where no
  /// joint opens that opens or closes the hand.
  double opening = 0.0;
  double retreat = 0.0;  ///< Of the palm, against its direction [m].
};

/// Configurations on the straight path from one configuration to another: the palm's position (of
/// its frame's origin) and the joints change linearly, the palm's rotation along the shortest arc.
/// Share 0 is `from` and 1 is `to` to the last digit. @throws InvalidInput for unlike numbers of
/// joints and unless 0 ≤ share ≤ 1.
hands::HandConfiguration interpolated(const hands::HandConfiguration& from,
                                      const hands::HandConfiguration& to, double share);

/// The pre-grasp with the least opening, and for it the least retreat, in which the hand is clear
/// of object and surroundings by `clearance` and from which it can move straight to the grasp
/// without touching them, or itself, on the path.
///
/// Openings are 1/n, 2/n, …, 1 (n = `opening_steps`) of the motion of every closing joint to its
/// position in `open_configuration`; followers move by their couplings, and neutral joints (spread,
/// abduction) stay. Retreats are 0 and the multiples of `retreat_step` up to `largest_retreat`.
/// Every combination is tried in that order. Where none is a pre-grasp, there is with
/// `leave_pressing` another round, in which joints stay whose opening moves the point of a link
/// that is nearest to the object, within 1 mm of it and not on it, towards it (in the grasp, to
/// first order; each joint with its followers, and without the others); with `open_neutral` neutral
/// joints open by the same share in that round, and in a last one all do. The result is empty if no
/// combination is a pre-grasp. A round ends, too, once it has asked for more than 8000 distances of
/// bodies that were not proven to stay apart, where a way on which bodies meet as they did on one
/// before counts for one.
///
/// That the path is free is proven, not sampled, by conservative advancement: two bodies at a
/// distance cannot meet before the fastest points of both have together moved by that distance.
/// Each link is tested in this manner against the object, the surroundings, and every other link
/// (except pairs that the model excludes or that share a point in the grasp itself), over the whole
/// path, its end included:
///
/// - bodies that are farther apart than `way_tolerance` in the grasp touch at no share in [0, 1];
/// - bodies that are nearer than that in the grasp, or touch in it, do not touch before the share
///   from which on none of their points has farther to move than `way_tolerance` (two links:
///   relative to each other).
///
/// A grasp that penetrates the object or the surroundings deeper than `way_tolerance` therefore has
/// no pre-grasp. Distances below 1e-8 m are not distinguished from touching, and a path that 500
/// distances per pair cannot prove free (links slide along the object with hardly a gap) counts as
/// not free: the path of a pre-grasp found is free, but a free path may be missed. Links are the
/// solids of their meshes, poses as `forward_kinematics` rounds them.
/// @throws InvalidInput for bad options, a grasp outside the hand's limits, and a number of link
/// poses that is not the hand's.
std::optional<PreGrasp> find_pre_grasp(const PreGraspScene& scene,
                                       const hands::PosedConfiguration& grasp,
                                       const PreGraspOptions& options = {});

/// The same for a configuration whose link poses are not known yet.
std::optional<PreGrasp> find_pre_grasp(const PreGraspScene& scene,
                                       const hands::HandConfiguration& grasp,
                                       const PreGraspOptions& options = {});

}  // namespace graspfit::grasp
