#pragma once

#include <vector>

#include "graspfit/base/random.hpp"
#include "graspfit/geometry/surface_sampling.hpp"
#include "targets/target_feasibility.hpp"

namespace graspfit::grasp::internal {

/// Target sets drawn at random from surface samples: the paper's words on GS read literally.
class SampleTargets {
 public:
  /// Refers to object and distances. @throws InvalidInput as `TargetSelector`.
  SampleTargets(const ObjectModel& object, const PartDistances& distances,
                const RequestedParts& parts, const TargetOptions& options,
                const std::vector<geometry::SurfaceSample>& samples);

  /// One set, each of its targets drawn from all samples alike. Sets are drawn, a hundred times
  /// `max_seeds` at most, until the distances are within the fingers' ranges and each target forms
  /// a stable pair with the seed; scores, edges and centroid do not count. The result has no
  /// targets where no set was found.
  TargetSelection select(base::Random& random) const;

 private:
  const TargetRules rules_;
};

}  // namespace graspfit::grasp::internal
