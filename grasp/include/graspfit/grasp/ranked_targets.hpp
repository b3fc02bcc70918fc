#pragma once

#include <memory>
#include <optional>

#include "graspfit/grasp/target_contacts.hpp"

namespace graspfit::grasp {

/// All feasible target sets, best first (`TargetSearch::Ranked`) [R]. The search is complete: if it
/// ends without any set, the pool has none within the unrelaxed limits, and `failure` says at which
/// stage the search failed.
///
/// A set is a seed and a set of further targets; it is feasible if the greedy search could choose
/// it in some order, the limits not relaxed. Its rank is the least over those orders of
///
///     mean of | |ViVj| − |V1V2| | / |V1V2| over all edges but the first
///   + distance of the centroid of all targets from the center of mass / normalizing radius
///   + angle_weight · mean over the pairs that must be stable of their angle / theta_max
///   + mean distance from the tips' reach / normalizing radius (palm),
///
/// the terms that the greedy search ranks its candidates by. Sets come by ascending rank, each once
/// in its best order; equal ranks by ascending patches in that order. A set of two targets comes
/// twice, with either one as the seed.
///
/// Search: depth first through the stable pairs, cut off by a growing limit on the rank, keeping
/// the best few thousand sets of each round. Memory: 4 bytes per stable pair of the pool, and the
/// kept sets. Cost: at 30 voxels (3000 points) well under a second to the first set for two and
/// three targets, seconds to prove that there is none; for more, see `pool_spacing`.
class RankedTargets {
 public:
  /// Object and distances are referred to, not copied: they have to outlive the search.
  /// @throws InvalidInput as `TargetSelector`, and for a pool of more than 16384 points.
  RankedTargets(const ObjectModel& object, const PartDistances& distances,
                const RequestedParts& parts, const TargetOptions& options);
  ~RankedTargets();
  RankedTargets(RankedTargets&&) noexcept;

  /// The next best set; empty when there are no more.
  std::optional<TargetContacts> next();

  /// Why there is no set at all, once the first call of `next` has returned none.
  TargetFailure failure() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace graspfit::grasp
