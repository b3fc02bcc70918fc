#pragma once

#include <Eigen/Core>
#include <compare>
#include <map>
#include <optional>
#include <vector>

#include "graspfit/grasp/target_contacts.hpp"
#include "graspfit/hands/hand_configuration.hpp"

/// \file
/// Directions around the palm: by what angle a finger misses pointing at its target, and the
/// positions of swing joints that make it point there. Steps 3 and 4 of the paper's loop, its
/// initial configuration and the assignment of fingers share these.

namespace graspfit::grasp::internal {

/// Signed angle [rad] that turns `from` toward `to` about the unit `axis`, both seen along it, in
/// (−π, π]; zero where one of them is parallel to the axis.
double azimuth_error(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                     const Eigen::Vector3d& axis);

/// Azimuth error of a finger toward a point, about the origin of the finger's swing axis, or about
/// the palm center where the finger does not swing. Only the finger's own chain is posed.
class AzimuthOfFinger {
 public:
  AzimuthOfFinger(const hands::HandModel& hand, int finger);

  double error(const hands::HandConfiguration& configuration, const Eigen::Vector3d& point_O);

 private:
  const hands::HandModel& hand_;
  const hands::Finger& finger_;
  std::vector<int> chain_;
  Eigen::Vector3d contact_C_;
  std::vector<geometry::RigidTransform> X_OL_;  ///< Of the links of the chain.
};

/// A finger and the target that it is to point at.
struct FingerTarget {
  int finger = 0;
  int target = 0;
  auto operator<=>(const FingerTarget&) const = default;
};

/// The position of `leader` with the least sum of squared errors: samples of its range, the
/// best one refined by golden section; the error has one minimum per turn of a finger.
double best_swing(const hands::HandModel& hand, const hands::HandConfiguration& configuration,
                  const TargetContacts& targets, int leader,
                  const std::vector<FingerTarget>& pairs);

/// Fingers with their targets, grouped by the independent joint that swings them; fingers that do
/// not swing come first.
std::map<std::optional<int>, std::vector<FingerTarget>> pairs_by_leader(
    const hands::HandModel& hand, const TargetContacts& targets);

/// Joint positions in which every finger that can swing around the palm points at its assigned
/// target as well as the joints allow; fingers that share a joint take the least sum of squared
/// errors. Other joints as in `configuration`.
Eigen::VectorXd aligned_swing(const hands::HandModel& hand,
                              const hands::HandConfiguration& configuration,
                              const TargetContacts& targets);

}  // namespace graspfit::grasp::internal
