#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "graspfit/grasp/object_model.hpp"
#include "graspfit/grasp/target_contacts.hpp"

namespace graspfit::grasp {

/// A palm pose to start from: which way the palm looks and how it is turned.
struct PalmPlacement {
  Eigen::Vector3d direction_O = Eigen::Vector3d::UnitZ();  ///< n_palm in O, unit.
  double turn = 0.0;  ///< About n_palm, on from where the seed's finger looks at the seed [rad].
  /// How far the palm center should stay before the targets' centroid along n_palm, because the
  /// object is there [m]; empty where the palm has a target of its own.
  std::optional<double> palm_room = {};
};

/// Candidate palm placements for a set of targets: ± the normal of the target triangle; 16
/// around the axis for two targets; the least-squares plane's normals for more than three; where
/// the last target is the palm's, against the normal of that alone, in eight turns about it if the
/// seed lies on the palm's axis (within 10 mm) and so leaves them open. Those with more room first
/// or, with an approach direction, those within `approach_angle` [rad] of it, nearest first.
///
/// @param approach_O not zero; its length does not matter.
std::vector<PalmPlacement> palm_placements(const ObjectModel& object, const TargetContacts& targets,
                                           const std::optional<Eigen::Vector3d>& approach_O,
                                           double approach_angle);

}  // namespace graspfit::grasp
