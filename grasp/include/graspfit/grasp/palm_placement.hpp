#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "graspfit/grasp/object_model.hpp"
#include "graspfit/grasp/target_contacts.hpp"

namespace graspfit::grasp {

/// A palm pose to start from: the direction that the palm faces and the turn about that direction.
struct PalmPlacement {
  Eigen::Vector3d direction_O = Eigen::Vector3d::UnitZ();  ///< n_palm in O, unit.
  /// Turn about n_palm, counted from the pose in which the seed's finger points at the seed [rad].
  double turn = 0.0;
  /// Distance that the palm center should keep before the targets' centroid along n_palm, because
  /// the object extends that far [m]; empty where the palm has a target of its own.
  std::optional<double> palm_distance = {};
};

/// Candidate palm placements for a set of targets. For three targets the palm faces along ± the
/// normal of their triangle; for two, along 16 directions perpendicular to the line through them;
/// for more than three, along the normals of the least-squares plane. Where the last target is the
/// palm's, the palm faces against that target's normal alone, in eight turns about it if the seed
/// lies on the palm's axis (within 10 mm) and so does not determine the turn. Placements on whose
/// side the object protrudes less from the targets' centroid come first or, with an approach
/// direction, only those within `approach_angle` [rad] of it are given, the nearest first.
///
/// @param approach_O not zero; its length does not matter.
std::vector<PalmPlacement> palm_placements(const ObjectModel& object, const TargetContacts& targets,
                                           const std::optional<Eigen::Vector3d>& approach_O,
                                           double approach_angle);

}  // namespace graspfit::grasp
