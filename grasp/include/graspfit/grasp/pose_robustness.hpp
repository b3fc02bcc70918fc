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
  double rotation_deviation =
      0.087266462599716477;  ///< Of each component of the rotation vector [rad], ≥ 0; 5°.
  double reach = 0.02;       ///< How far a pad goes on, or gives way, to meet the surface [m], > 0.
  std::uint64_t seed = 1;    ///< Sample i is the same for every grasp: its stream is (seed, i).
  void validate() const;     ///< Throws InvalidInput naming the field and its value.
};

/// What becomes of a grasp when the object is not quite where it was thought to be [after Weisz &
/// Allen 2012].
struct PoseRobustness {
  double closed_share = 0.0;  ///< Of the poses: force closure. Its standard error is at most
                              ///< 0.5 / √num_samples.
  std::optional<double> usable_share;  ///< Of the poses: M > 0; empty without `quality_context`.
  double mean_epsilon = 0.0;           ///< In the facts' convention, 0 without closure.
  double mean_num_contacts = 0.0;
};

/// Moves the contacts' pads as rigidly as a hand that is off by Gaussian noise: a turn about the
/// center of mass, then a shift. Each pad then goes along its own contact's inward normal, from
/// `reach` before to `reach` beyond its place, until it meets the front of the surface; the contact
/// is there, with the face's normal, and keeps its area, its distance from the pad's outline and
/// its gap: a pad that bears no force in the grasp bears none here. One that meets no surface has
/// no contact.
///
/// So fingers give way along their contact's normal only, and neither joint limits nor other parts
/// of the hand count: a model of compliance, not a simulation of closing. Empty without contacts or
/// without `surface`. Same facts and options, same numbers.
/// @throws InvalidInput for bad options, and as the metrics do for bad facts.
std::optional<PoseRobustness> pose_robustness(const GraspMetricFacts& facts,
                                              const PoseRobustnessOptions& options = {});

}  // namespace graspfit::grasp
