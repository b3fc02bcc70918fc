#pragma once

#include <optional>

#include "graspfit/grasp/grasp_scene.hpp"
#include "graspfit/grasp/palm_placement.hpp"
#include "graspfit/grasp/target_contacts.hpp"
#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::grasp {

/// Grasp style (paper section 12).
enum class GraspStyle {
  Precision,  ///< Targets go to the fingertips.
  Power,      ///< Targets go to the fingertips and the palm; the palm is brought to the surface
              ///< first and links behind the tips are closed onto it. With
              ///< `TargetSearch::Reach` to the palm and the fingertips, or the pads behind these,
              ///< and no link is closed onto it but by `IdleFingers` [R].
  Auto,       ///< Targets go to fingertips alone, to them and the palm, or to one finger more, of
              ///< any fingers beside the thumb unless they are named, or to the palm and the pads
              ///< behind the tips: where the strongest posture is found [R]; with
              ///< `TargetSearch::Reach` only.
};

/// Which motions of the hand the guard refuses (paper section 9).
enum class PenetrationGuard {
  /// Motions in which a link's surface would enter a full voxel: d_min < 0 [P]. The hand may also
  /// not end with the true meshes deeper in each other than a voxel's edge, which d_min alone
  /// allows where a partial voxel is entered along its diagonal [R].
  Voxels,
  /// In addition, where a link shares voxels with the surface (d_min = 0), motions after which the
  /// true meshes would intersect, decided exactly [R].
  Meshes,
};

/// When a closing part (a finger or the palm) counts as touching the object.
enum class ContactState {
  /// When the guard would refuse the part's next motion, or that motion would take the object's
  /// surface out of the pad's clip volume: fingers "stop their movements by touching the object
  /// surface" [P].
  Closed,
  /// When the pad's clip volume first holds a sliver of the object's surface: the pad is then up to
  /// a clip thickness before the surface, and the contact has a few hundredths of the pad's area.
  /// No reading of the paper [R]. Without refinement it is for comparison. With refinement
  /// (`PlannerOptions::refine`) the planner closes all hands in this way, whatever its options say:
  /// refinement makes the contacts real, and would undo any further closing.
  FirstGraze,
};

/// What the palm does once a finger touches.
enum class PalmAfterContact {
  Frozen,  ///< The palm stays where it is: a shift would drag the finger.
  /// Once the fingers have closed, the palm moves on, as long as contacts come nearer to targets,
  /// in small steps that bring the mean of the contacts toward the mean of their targets. Fingers
  /// open where a step needs it and close again.
  Recentred,
};

/// Parameters of the fitting loop (paper sections 7–9).
struct FittingOptions {
  double clearance = 0.02;  ///< Between the object and the palm at the start [m], in [0, 10] [R].
  double large_step_at = 2.0;  ///< d_min from which large steps are taken [voxels] [P: "e.g. 2"].
  double large_step_limit =
      8.0;                   ///< Largest motion of the fastest point in a large step [voxels] [R].
  double small_step = 0.2;   ///< Motion of the fastest point in a small step [voxels], > 0 [R].
  int max_halvings = 5;      ///< Of a step that would penetrate [R].
  int max_iterations = 400;  ///< Of the loop, ≥ 1.
  /// Of the points that stand for a link's occupied voxels [voxels], > 0.
  double sample_spacing = 0.5;
  PenetrationGuard guard = PenetrationGuard::Meshes;  ///< [R]; the paper's is Voxels.
  /// The default is the paper's [P]. The planner heeds this field without refinement only; with
  /// refinement all hands close to the first graze.
  ContactState contact_state = ContactState::Closed;
  /// Closing onto the surface (`ContactState::Closed`) ends when its steps are shorter than this
  /// [m], > 0.
  double closing_tolerance = 1e-5;
  PalmAfterContact palm_after_contact = PalmAfterContact::Recentred;  ///< [R]
  /// Whether the guard also refuses motions that bring links of the hand into each other, except
  /// pairs that the model excludes [R]. Without it fingers close through each other, and refinement
  /// has to separate them. Links that already intersect where the loop starts may continue to do
  /// so.
  bool guard_self = false;
  double give_up_distance = 0.03;  ///< A part that has stopped farther than this from the object
                                   ///< ends the attempt [m], ≥ 0: refinement reaches as far [R].
  void validate() const;           ///< Throws InvalidInput naming the field and its value.
};

/// How an attempt to fit the hand ended.
enum class FittingStop {
  Contact,           ///< Every part with a target touches: a formed grasp.
  InitialCollision,  ///< No starting pose clear of the object was found.
  BlockedFinger,  ///< A part with a target was stopped by the object, or by the surroundings, where
                  ///< its pad does not touch.
  MissedContact,  ///< A part with a target reached its limits without touching.
  IterationLimit,  ///< Work budget used up.
};

/// A fitted hand.
struct FittingResult {
  FittingStop stop = FittingStop::IterationLimit;
  hands::HandConfiguration initial;        ///< Where the loop started.
  hands::HandConfiguration configuration;  ///< Where it ended.
  int iterations = 0;
  /// Largest distance of a requested pad's contact point from the object's surface [m], zero for
  /// pads with contact: what refinement would have to close.
  double largest_gap = 0.0;
  double contact_tests_s = 0.0;  ///< Time spent on contact estimation; not part of the result.
  /// d_min at the end [voxels]; ≥ 0: no link reaches a full voxel.
  double smallest_distance = 0.0;
};

/// Fits the hand to assigned targets: initial configuration (section 7), then the adjustment loop
/// of five steps (section 8) under the penetration guard (section 9).
///
/// Readings [R]. The paper's five steps come to rest in the posture in which the fingertips are
/// over their targets. That posture is found first, without the object, and steps 2 to 5 move the
/// hand toward it: the palm moves along n_palm to where the closed fingertips' centroid will be
/// over the targets' centroid; then each finger closes by all its joints together, then on by its
/// proximal joints and, where a link behind the tip is stopped, by its distal ones. In power grasps
/// the palm moves first, until its clip volume holds surface or the guard stops it; then every
/// finger, with a target or without, closes by its proximal joint until that is stopped, then by
/// the next. An attempt ends early when a part has stopped farther than `give_up_distance` from the
/// object.
///
/// Guarantee: no sampled point of a link lies in a full voxel at the end (d_min ≥ 0), and, with the
/// guard on meshes, no link intersects the object. With the guard on voxels the true meshes may
/// intersect. No configuration on the path touches the surroundings. Links of the hand may
/// intersect each other in either case, unless `guard_self` keeps them apart. The guarantee does
/// not hold if the result is `InitialCollision`.
/// @throws InvalidInput for options out of range, fewer than two targets or unassigned ones.
///
/// @param goal the posture at the targets toward which the loop moves the hand, if it is known
/// already; empty: it is computed.
FittingResult fit_hand(const GraspScene& scene, GraspStyle style, const TargetContacts& targets,
                       const PalmPlacement& placement, const FittingOptions& options,
                       const std::optional<hands::HandConfiguration>& goal = {});

/// How a hand that starts in collision backs off, against its palm direction.
struct RetreatRule {
  std::optional<double> step = {};  ///< [m], > 0; empty: a voxel.
  /// ≥ 0; empty: as many as take the whole hand past the object.
  std::optional<int> most_steps = {};
  /// Whether the fingers close even if the hand is still not clear after its last step: links that
  /// are inside the object stay where they are, and the result may have d_min < 0.
  bool closes_in_collision = false;
  /// Whether a hand that has backed off goes back again until its palm touches, or the guard stops
  /// it, but not beyond where it started.
  bool palm_may_touch = false;
};

/// Closes the fingers of an open hand from a given pose: the way in which planning methods without
/// target contacts close hands. The hand backs off until it is clear; the palm, if it is requested,
/// moves on to the surface, by four voxels at most; then the requested fingers (of power grasps
/// all) close joint by joint, proximal to distal, under the same guard, contact tests and budget as
/// in `fit_hand`, until each touches, is stopped or is at its limits.
///
/// @throws InvalidInput for options out of range, no finger, one without a fingertip pad, or other
/// pads.
FittingResult close_hand(const GraspScene& scene, GraspStyle style, const RequestedParts& requested,
                         const hands::HandConfiguration& start, const RetreatRule& retreat,
                         const FittingOptions& options);

}  // namespace graspfit::grasp
