#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::grasp {

/// When two grasps count as different: if any of these is exceeded [R].
struct DistinctOptions {
  double translation = 0.01;             ///< Between palm centers in O [m], ≥ 0.
  double rotation = 0.2617993877991494;  ///< Between palm orientations [rad], ≥ 0; 15°.
  double joints = 0.2;  ///< Largest difference of an independent joint [rad], ≥ 0; of prismatic
                        ///< joints after division by `slide_scale`.
  double slide_scale = 0.1;  ///< Travel of a prismatic joint that counts as one radian [m], > 0:
                             ///< about the lever of a finger.
  void validate() const;     ///< Throws InvalidInput naming the field and its value.
};

/// How far two configurations of a hand are apart.
struct ConfigurationDistance {
  double translation = 0.0;  ///< Between the palm centers in O [m].
  double rotation = 0.0;     ///< Least angle that turns one palm as the other [rad], in [0, π].
  double joints = 0.0;       ///< As `DistinctOptions::joints` counts it.
};

/// The distance is symmetric, and the same after a rigid motion of both hands (the palm moves, the
/// joints do not). Coupled joints do not count, whether broken away or not. Results are rounded.
/// @throws InvalidInput if a configuration does not have the hand's number of joints, or
/// `slide_scale` is not a positive length.
ConfigurationDistance configuration_distance(const hands::HandModel& hand,
                                             const hands::HandConfiguration& a,
                                             const hands::HandConfiguration& b, double slide_scale);

/// Whether two grasps of one object count as different; equal grasps never do, whatever the
/// options. Being alike is not transitive: a chain of alike grasps may lead anywhere.
/// @throws InvalidInput for bad options, and as `configuration_distance`.
bool are_distinct(const hands::HandModel& hand, const hands::HandConfiguration& a,
                  const hands::HandConfiguration& b, const DistinctOptions& options = {});

/// Indices, ascending, of grasps that are all distinct from one another, taken greedily from the
/// first on: give them best first. Every grasp left out is alike a kept one before it. Cost: the
/// given ones times the kept ones. @throws InvalidInput as `are_distinct`.
std::vector<std::size_t> distinct_subset(const hands::HandModel& hand,
                                         std::span<const hands::HandConfiguration> best_first,
                                         const DistinctOptions& options = {});

}  // namespace graspfit::grasp
