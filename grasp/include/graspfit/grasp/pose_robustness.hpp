#pragma once

#include <cstdint>
#include <optional>

namespace graspfit::grasp {

struct GraspMetricFacts;

/// Noise of the object's pose in the hand. Defaults are ours [R]; others evaluate with up to 10 mm
/// and 5° (Simox).
struct PoseRobustnessOptions {
  int num_samples = 100;                 ///< Poses, ≥ 1.
  double translation_deviation = 0.005;  ///< Standard deviation along each axis [m], ≥ 0.
  /// Of each component of the rotation vector [rad], ≥ 0; 5°.
  double rotation_deviation = 0.087266462599716477;
  double reach = 0.02;     ///< How far a pad goes on, or gives way, to meet the surface [m], > 0.
  std::uint64_t seed = 1;  ///< Sample i is the same for every grasp: its stream is (seed, i).
  void validate() const;   ///< Throws InvalidInput naming the field and its value.
};

/// What becomes of a grasp when the object is not quite where it was thought to be [after Weisz &
/// Allen 2012].
struct PoseRobustness {
  double closed_share = 0.0;  ///< Share of the poses with force closure. Its standard error is at
                              ///< most 0.5 / √num_samples.
  /// Share of the poses with M > 0; empty without `quality_context`.
  std::optional<double> usable_share;
  /// Mean ε in the facts' wrench convention, 0 for poses without closure.
  double mean_epsilon = 0.0;
  double mean_num_contacts = 0.0;
};

/// Moves the pads of the contacts rigidly, as with a hand whose pose is off by Gaussian noise: by a
/// turn about the center of mass, then by a shift. Each pad then moves along the inward normal of
/// its own contact, from `reach` before to `reach` beyond its position, until it meets the front of
/// the surface. The new contact is at that point, with the face's normal, and keeps its area, its
/// distance from the pad's outline and its gap: a pad that bears no force in the grasp bears none
/// here. A pad that meets no surface has no contact.
///
/// Fingers thus yield along their contact's normal only, and neither joint limits nor other parts
/// of the hand count: this is a model of compliance, not a simulation of closing. The result is
/// empty without contacts or without `surface`. The same facts and options give the same numbers.
/// @throws InvalidInput for bad options, and as the metrics do for bad facts.
std::optional<PoseRobustness> pose_robustness(const GraspMetricFacts& facts,
                                              const PoseRobustnessOptions& options = {});

}  // namespace graspfit::grasp
