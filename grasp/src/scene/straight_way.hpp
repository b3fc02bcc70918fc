#pragma once

#include <functional>
#include <vector>

#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::grasp::internal {

/// Share of a distance that a proof is content with: the rest costs more than steps more do.
inline constexpr double kNearEnough = 0.6;

/// Least angle between two orientations [rad].
double turn_between(const hands::RigidTransform& from, const hands::RigidTransform& to);

/// The straight way of a hand from one configuration to another (`interpolated`), and how far its
/// links go on it: upper bounds of the speeds of all their points per unit of the way's share.
class StraightWay {
 public:
  StraightWay(const hands::HandModel& hand, const hands::HandConfiguration& from,
              const hands::HandConfiguration& to);

  /// Upper bound of the speed in O of any point of a link [m]: palm translation, palm rotation
  /// times reach, and joint motions times levers, where a reach is a sum of the lengths of a chain.
  double speed(int link) const { return speeds_[link]; }

  /// The same for the motion of two links against each other: only joints between them count.
  double relative_speed(int link_a, int link_b) const;

 private:
  /// Speed of the points of `link` in the frame of an ancestor (the link itself: 0).
  double speed_in(int link, int ancestor) const;

  const hands::HandModel& hand_;
  const Eigen::VectorXd motion_;  ///< Per joint, over the whole way, ≥ 0.
  std::vector<double> radii_;     ///< Per link: of its points from its frame's origin.
  std::vector<double> levers_;    ///< Per link: of its points from the axis of its joint.
  std::vector<double> offsets_;   ///< Per link: of its frame from its parent's, largest on the way.
  std::vector<double> speeds_;
};

/// Lower bound of the distance of two bodies at a share of the way; what lies beyond `enough` is
/// not searched, so that the bound may be `enough` itself.
using DistanceOnWay = std::function<double(double share, double enough)>;

/// Whether two bodies are surely apart on the whole way from share 0 to 1, by conservative
/// advancement from both ends and by halves in between: a distance d at one share keeps bodies of
/// relative speed v apart up to d / v before and after it. Over the last segment, in which no point
/// moves by more than `tolerance`, they may be as near as they like; without a tolerance, bodies
/// that do not move are apart if they are apart where they stand.
///
/// False: they touch (come within 1e-8 m, which is not told from touching), or it could not be
/// proven in 500 distances, as where bodies slide along each other without a gap to speak of.
bool are_apart_on_way(double relative_speed, double tolerance, const DistanceOnWay& distance);

}  // namespace graspfit::grasp::internal
