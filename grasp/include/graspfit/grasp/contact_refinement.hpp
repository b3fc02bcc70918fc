#pragma once

#include <vector>

#include "graspfit/grasp/grasp_scene.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::grasp {

/// Limits of contact refinement, which is this library's own: the paper ends at voxels [R].
struct RefinementOptions {
  double wanted_gap = 2e-5;      ///< To which requested pads are brought [m], in (0, largest_gap).
  double largest_gap = 1e-4;     ///< A requested pad within this has contact [m], > 0.
  double least_distance = 1e-6;  ///< Kept between all that must not touch [m], > 0.
  /// Upper limit of each of the numbers of steps below, more than ten times their usual values:
  /// every step makes exact queries for every pad, and an attempt has to end.
  static constexpr int kMostSteps = 1000;

  int max_iterations = 60;  ///< In [1, kMostSteps].
  /// Number of steps in which touching pads then slide over the surface toward their targets, in
  /// [0, kMostSteps]; 0: they stay where they first touch. Sliding gives a larger M at the cost of
  /// more work.
  int slide_steps = 0;
  /// Number of steps, at most, in which each further pad that nearly touches (its clip volume holds
  /// surface) is then brought into contact too, provided that all others keep touching, in
  /// [0, kMostSteps]; it is given up after two that hardly shrink the gaps. 0: such pads are left
  /// as they are.
  int near_pad_steps = 12;
  double reach = 0.03;  ///< Pads farther from the object than this at the start are given up [m].
  double largest_shift = 0.03;  ///< Of the palm from where it started [m], ≥ 0; 0: it stays.
  double largest_turn = 0.5;    ///< Of the palm from where it started [rad], ≥ 0.
  void validate() const;        ///< Throws InvalidInput naming the field and its value.
};

/// How a refinement ended.
enum class RefinementStop {
  Contact,        ///< Every requested pad has contact, nothing penetrates.
  Intersecting,   ///< No configuration near the start was clear of object and surroundings.
  OutOfReach,     ///< A requested pad was too far from the object.
  GapLeft,        ///< No small motion lowered the gaps further: something else touches first.
  SelfCollision,  ///< No configuration near the start was clear of the hand itself.
  IterationLimit,
};

/// A refined hand.
struct RefinementResult {
  RefinementStop stop = RefinementStop::IterationLimit;
  hands::HandConfiguration configuration;  ///< Clear of the object, the surroundings and itself,
                                           ///< decided exactly, unless `stop` is Intersecting
                                           ///< or SelfCollision.
  double largest_gap = 0.0;  ///< Largest gap of a requested pad [m]; a value of twice `reach`
                             ///< stands for that or more.
  int iterations = 0;
};

/// Brings every requested pad to touch: from a configuration near contact, such as `fit_hand` ends
/// at, to one where each of `requested_pads` is within `largest_gap` of the object's surface and no
/// link touches the object anywhere, the surroundings, or another link (exclusions besides).
///
/// Method: constrained least squares on nearest points. Each step is the motion of palm and
/// independent joints, small in a weighted norm, that to first order takes the gaps of requested
/// pads to `wanted_gap` while no near pair of bodies comes closer than `least_distance`; it is
/// shortened until the rounded distances are at least half of `least_distance`. That the start and
/// the end are clear is decided exactly on the true meshes; if the end is not, the result is
/// GapLeft and the clear start. A start that penetrates something is first opened, straightened and
/// withdrawn until it is clear. Where `targets` are given, pads are also drawn, weakly, toward
/// their targets and toward lying flat on the surface there; with `slide_steps` they are drawn
/// strongly once they touch, and of the configurations in which all requested pads touch the one
/// nearest to the targets is kept. Finally, further pads that nearly touch, the nearest first, are
/// treated as requested ones for a few steps, and given up where these steps do not end with all
/// pads in contact.
///
/// Gap: as `Contact::gap`, the distance between the pad's part of the link's mesh and the object.
/// Deterministic.
RefinementResult refine_contacts(const GraspScene& scene, const std::vector<int>& requested_pads,
                                 const TargetContacts* targets,
                                 const hands::HandConfiguration& start,
                                 const RefinementOptions& options);

}  // namespace graspfit::grasp
