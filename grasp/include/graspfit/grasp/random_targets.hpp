#pragma once

#include <memory>

#include "graspfit/base/random.hpp"
#include "graspfit/grasp/target_contacts.hpp"

namespace graspfit::grasp {

/// Picks targets by the paper's randomized greedy search (section 6): a random seed above the
/// threshold; a second contact in tip distance and in both cones; further contacts with edges close
/// to the first and a centroid close to the center of mass; each drawn at random from the
/// best-ranked feasible candidates; a new seed where one has none.
///
/// Fingers' targets come first, the seed's first of all. Distances are checked finger by finger:
/// for every set returned, at least one way to give the seed to the first finger and the other
/// targets to the others has every two of them within those fingers' own range (`assign_fingers`
/// chooses one way).
///
/// A target for the palm, if `parts` has it, comes last and is the only one assigned here
/// (`is_palm`). With n its outward normal, the palm there looks along −n. It is chosen so that
///  - no other surface stands in the palm's way: within the pad's radius around n, none is higher
///    than a voxel over the target's plane;
///  - every finger's target is in front of the palm: (V − palm) · n < 0;
///  - some turn of the hand about n and some assignment that suits the fingers' own ranges has
///    every finger's target at a distance in `palm_to_tip` and within `palm_reach_tolerance` of a
///    place that the finger's tip gets to with its pad looking into the surface, roughly
///    (`hands::TipReach`; turns are sampled, 5° apart).
/// It need not form a stable pair. Its rank is the distance of the whole set's centroid from the
/// center of mass, plus the mean distance from the tips' reach, both over the normalizing radius.
///
/// @throws InvalidInput for fewer than two fingers, more than six parts, a finger that the hand
/// does not have, without a tip pad or named twice; for the palm of a hand without a palm pad; and
/// for five or more fingers with `PairRule::AllPairs` and theta_max ≤ 45°, which no object has.
class TargetSelector {
 public:
  /// Object, distances and the measure's hand are referred to, not copied: they have to outlive the
  /// selector. `ideal` is what `ideal_m_bias` prefers sets by.
  TargetSelector(const ObjectModel& object, const PartDistances& distances,
                 const RequestedParts& parts, const TargetOptions& options,
                 const IdealMeasure& ideal = {});
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
