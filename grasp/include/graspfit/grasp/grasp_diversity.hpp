#pragma once

#include <optional>
#include <span>

#include "graspfit/grasp/distinct_grasps.hpp"
#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::grasp {

/// How varied a set of grasps of one hand and object is.
struct GraspDiversity {
  int num_grasps = 0;
  /// Grasps linked by chains of grasps that are not distinct form one cluster.
  int num_clusters = 0;
  /// Share of the variance along the first principal axis, in (0, 1]: 1 is all grasps on a line;
  /// the more evenly a set fills all directions, the smaller. Empty for grasps that are all equal.
  std::optional<double> first_axis_share;
};

/// Both measures use the distances of `options`. Clusters are formed by `are_distinct`; the
/// principal axis is that of points whose coordinates are the palm center over `translation`, the
/// palm's rotation matrix over √2 `rotation` (for small turns as long as the angle over `rotation`)
/// and the independent joints over `joints` (prismatic joints over `joints` times `slide_scale`).
/// Neither measure depends on the order of the grasps, nor on the frame O but for rounding. Cost:
/// all pairs.
/// @throws InvalidInput as `are_distinct`, and for distances in `options` that are zero.
GraspDiversity grasp_diversity(const hands::HandModel& hand,
                               std::span<const hands::HandConfiguration> configurations,
                               const DistinctOptions& options = {});

}  // namespace graspfit::grasp
