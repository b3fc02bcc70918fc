#pragma once

#include <memory>

#include "graspfit/base/random.hpp"
#include "graspfit/grasp/target_contacts.hpp"

namespace graspfit::grasp {

/// Selects targets by the paper's randomized greedy search (section 6). The seed is a random point
/// with a score above the threshold. The second contact is within the distances that fingertips
/// reach and forms a stable pair with the seed; further contacts have edges close in length to the
/// first edge and a centroid close to the center of mass. Each contact is drawn at random from the
/// best-ranked feasible candidates; where there are none, the search starts again from a new seed.
///
/// Fingers' targets come first, the seed's first of all. Distances are checked finger by finger:
/// for every set returned there is at least one assignment, with the seed to the first finger, in
/// which every two targets are within the distance range of their two fingers (`assign_fingers`
/// chooses an assignment).
///
/// A target for the palm, if `parts` has it, comes last and is the only one assigned here
/// (`is_palm`). With n the target's outward normal, the palm faces along −n. The target is chosen
/// so that
///  - no other surface obstructs the palm: within the pad's radius around n, none is higher than a
///    voxel over the target's plane;
///  - every finger's target is in front of the palm: (V − palm) · n < 0;
///  - for some turn of the hand about n and some assignment within the fingers' distance ranges,
///    every finger's target is at a distance in `palm_to_tip` and within `palm_reach_tolerance` of
///    a point that the fingertip reaches with its pad facing the surface, roughly
///    (`hands::TipReach`; turns are sampled, 5° apart).
/// The palm's target need not form a stable pair. The rank of a candidate is the distance of the
/// whole set's centroid from the center of mass, plus the mean distance from the tips' reach, both
/// over the normalizing radius.
///
/// @throws InvalidInput for fewer than two fingers, more than six parts, a finger that the hand
/// does not have, without a tip pad or named twice; for the palm of a hand without a palm pad; and
/// for five or more fingers with `PairRule::AllPairs` and theta_max ≤ 45°, which no object has.
class TargetSelector {
 public:
  /// Object, distances and the measure's hand are referred to, not copied: they have to outlive the
  /// selector. `ideal` says how the M of sets is computed that `ideal_m_bias` prefers them by.
  TargetSelector(const ObjectModel& object, const PartDistances& distances,
                 const RequestedParts& parts, const TargetOptions& options,
                 const IdealMeasure& ideal);
  ~TargetSelector();
  TargetSelector(TargetSelector&&) noexcept;

  /// One set; the same random numbers give the same one. Several threads may ask at once, each with
  /// its own random numbers.
  TargetSelection select(base::Random& random) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace graspfit::grasp
