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
  double largest_retreat = 0.1;  ///< Of the palm, against its direction [m], in [0, 10].
  double retreat_step = 0.01;    ///< [m], > 0; at most 1000 of them up to `largest_retreat`.
  int opening_steps = 10;        ///< From the grasp's joints to open ones, in [1, 1000].
  /// Whether neutral joints (spread, abduction) may go with the closing ones where nothing else is
  /// free: fingers drawn together around an object cross each other when they straighten.
  bool open_neutral = false;
  double way_tolerance = 1e-5;  ///< Over so much of the end of the way, bodies that touch in the
                                ///< grasp, or nearly, may already do so [m], > 0: half of the gap
                                ///< that refinement leaves.
  void validate() const;        ///< Throws InvalidInput naming the field and its value.
};

/// Where to start from (evaluation of grasps in the field: pre-grasp, grasp, squeeze).
struct PreGrasp {
  hands::HandConfiguration configuration;
  double clearance = 0.0;  ///< Of the nearest link [m], ≥ the wanted one.
  double opening = 0.0;  ///< Share of the way from the grasp's joints to the open ones, in (0, 1].
  double retreat = 0.0;  ///< Of the palm, against its direction [m].
};

/// Poses on the straight way from one configuration to another: palm position (of its frame's
/// origin) linear, its rotation along the shortest arc, joints linear. Share 0 is `from` and 1 is
/// `to` to the last digit. @throws InvalidInput for unlike numbers of joints and unless 0 ≤ share ≤
/// 1.
hands::HandConfiguration interpolated(const hands::HandConfiguration& from,
                                      const hands::HandConfiguration& to, double share);

/// The least opening, and for it the least retreat, from which the hand is clear of object and
/// surroundings by `clearance` and can go straight to the grasp without touching them on the way,
/// nor itself.
///
/// Openings are 1/n, 2/n, …, 1 (n = `opening_steps`) of the way of every closing joint to where
/// `open_configuration` has it, followers by their couplings; neutral joints (spread, abduction)
/// stay. Retreats are 0 and the multiples of `retreat_step` up to `largest_retreat`. Every
/// combination is tried in that order, then, with `open_neutral`, every one again with neutral
/// joints going the same share of their way, so that empty means: none of them.
///
/// That the way is free is proven, not sampled (conservative advancement): two bodies that are a
/// distance apart cannot meet before the fastest points of both have gone as far together. Each
/// link is held so against the object, the surroundings, and every other link (exclusions of the
/// model and pairs that share a point in the grasp itself besides), over the whole way, its end
/// included:
///
/// - bodies that the grasp holds apart by more than `way_tolerance` touch at no share in [0, 1];
/// - those that it holds apart by less, or lets touch, do not before the share from which on no
///   point of theirs has farther to go than `way_tolerance` (self: against each other).
///
/// So a grasp that cuts the object or the surroundings deeper than that has no pre-grasp. Nearer
/// than 1e-8 m is not told from touching, and what 500 distances per pair cannot prove (links that
/// slide along the object without a gap to speak of) counts as not free: an answer's way is free,
/// none may be missed. Links are the solids of their meshes, poses as `forward_kinematics` rounds
/// them.
/// @throws InvalidInput for bad options and a grasp outside the hand's limits.
std::optional<PreGrasp> find_pre_grasp(const hands::HandModel& hand,
                                       const hands::HandCollision& collision,
                                       const geometry::MeshQuery& object,
                                       const SurroundingsCollision& surroundings,
                                       const hands::HandConfiguration& grasp,
                                       const PreGraspOptions& options = {});

}  // namespace graspfit::grasp
