#pragma once

#include <functional>
#include <vector>

#include "graspfit/hands/hand_configuration.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::grasp::internal {

/// Share of a distance that suffices as its bound in a proof: a tighter bound costs more than the
/// steps that it saves.
inline constexpr double kNearEnough = 0.6;

/// Least angle between two orientations [rad].
double turn_between(const hands::RigidTransform& from, const hands::RigidTransform& to);

/// The straight path of a hand from one configuration to another (`interpolated`), with upper
/// bounds of the speeds of the points of its links, per unit of the path's share.
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
  /// Per link: largest distance of its points from its frame's origin.
  std::vector<double> radii_;
  std::vector<double> levers_;  ///< Per link: largest distance of its points from its joint's axis.
  /// Per link: largest distance of its frame from its parent's on the path.
  std::vector<double> offsets_;
  std::vector<double> speeds_;
};

/// Lower bound of the distance of two bodies at a share of the path; distances beyond `enough` are
/// not searched, so that the bound may be `enough` itself.
using DistanceOnWay = std::function<double(double share, double enough)>;

/// Whether two bodies are surely apart on the whole path from share 0 to 1, by conservative
/// advancement from both ends and by halves in between: a distance d at one share keeps bodies of
/// relative speed v apart up to d / v before and after it. Over the last segment, in which no point
/// moves by more than `tolerance`, the bodies may be at any distance; without a tolerance, bodies
/// that do not move are apart if they are apart where they stand.
///
/// The result is false if the bodies touch (come within 1e-8 m, which is not distinguished from
/// touching), or if 500 distances do not prove them apart, as where bodies slide along each other
/// with hardly a gap.
bool are_apart_on_way(double relative_speed, double tolerance, const DistanceOnWay& distance);

}  // namespace graspfit::grasp::internal
