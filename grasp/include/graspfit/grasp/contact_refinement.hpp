#pragma once

#include <vector>

#include "graspfit/grasp/grasp_scene.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::grasp {

/// Limits of contact refinement. It is ours: the paper ends at voxels [R].
struct RefinementOptions {
  double wanted_gap = 2e-5;      ///< To which requested pads are brought [m], in (0, largest_gap).
  double largest_gap = 1e-4;     ///< A requested pad within this has contact [m], > 0.
  double least_distance = 1e-6;  ///< Kept between all that must not touch [m], > 0.
  /// Largest number of steps of each kind below, more than ten times the usual ones: every step
  /// asks exact queries of every pad, and an attempt has to end.
  static constexpr int kMostSteps = 1000;

  int max_iterations = 60;  ///< In [1, kMostSteps].
  /// Steps in which pads that touch are then slid toward their targets, in [0, kMostSteps]; 0: they
  /// stay where they first touch. Larger M, more work.
  int slide_steps = 0;
  /// Steps in which each further pad that nearly touches (its clip volume holds surface) is then
  /// brought to touch too, where all others keep touching, in [0, kMostSteps]; 0: they stay.
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
  SelfCollision,  ///< The hand is in its own way.
  IterationLimit,
};

/// A refined hand.
struct RefinementResult {
  RefinementStop stop = RefinementStop::IterationLimit;
  hands::HandConfiguration configuration;  ///< Clear of the object, the surroundings and itself,
                                           ///< decided exactly, unless `stop` is Intersecting
                                           ///< or SelfCollision.
  double largest_gap = 0.0;  ///< Of the requested pads [m]; twice `reach` means: or more.
  int iterations = 0;
};

/// Brings every requested pad to touch: from a configuration near contact, such as `fit_hand` ends
/// at, to one where each of `requested_pads` is within `largest_gap` of the object's surface and no
/// link touches the object anywhere, the surroundings, or another link (exclusions besides).
///
/// Method: constrained least squares on nearest points. In each step the motion of palm and
/// independent joints, small in a weighted norm, that takes the gaps of requested pads to
/// `wanted_gap` while no near pair of bodies comes closer than `least_distance`, to first order;
/// the step is shortened until rounded distances leave half of that. That the start and the end are
/// clear is decided exactly on the true meshes; an end that is not counts as GapLeft, at the start.
/// A start that cuts something is first opened, straightened and withdrawn until clear. Where
/// `targets` are given, pads are also drawn, weakly, toward their targets and to lie flat on the
/// surface there; with `slide_steps`, strongly once they touch, and of the places where all
/// requested pads touch the one nearest to the targets is kept. At last further pads that nearly
/// touch, the nearest first, are treated as requested ones for a few steps, and let go where that
/// does not end with all of them in contact.
///
/// Gap: as `Contact::gap`, the distance between the pad's part of the link's mesh and the object.
/// Deterministic.
RefinementResult refine_contacts(const GraspScene& scene, const std::vector<int>& requested_pads,
                                 const TargetContacts* targets,
                                 const hands::HandConfiguration& start,
                                 const RefinementOptions& options);

}  // namespace graspfit::grasp
