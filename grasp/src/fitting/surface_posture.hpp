#pragma once

#include <vector>

#include "graspfit/grasp/fitting_hand.hpp"
#include "graspfit/grasp/object_model.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "object/nearest_patches.hpp"
#include "scene/hand_motion.hpp"

namespace graspfit::grasp::internal {

/// A posture in which pads lie on the object, at the level of patches.
struct SurfacePosture {
  hands::HandConfiguration configuration;
  std::vector<hands::RigidTransform> X_OL;
  std::vector<std::int32_t> patches;  ///< Per pad, the nearest one to its contact point.
  double largest_gap = 0.0;           ///< Of a pad's contact point from its patch [m].
  double largest_lean = 0.0;          ///< Of a pad against the normal of its patch [rad].
  double largest_depth = 0.0;         ///< Of a link's point below its patch [m].
};

/// Lays the contact points of `pads` onto the surface near where they are at `start`, and the pads
/// flat there, while links leave the object: damped Gauss-Newton steps of palm and joints on the
/// object's patches and its distance map. Approximate: to a fraction of a voxel; nothing is decided
/// exactly here.
class SurfaceSearch {
 public:
  /// Refers to hand, object, the nearest of all its patches and of those on which pads may lie.
  SurfaceSearch(const FittingHand& hand, const ObjectModel& object, const NearestPatches& nearest,
                const NearestPatches& places);

  SurfacePosture lay(const std::vector<int>& pads, const hands::HandConfiguration& start) const;

 private:
  class NormalEquations;
  struct DeepPoint {
    double depth = 0.0;  ///< [m]
    Eigen::Vector3d point_O = Eigen::Vector3d::Zero();
    Eigen::Vector3d outward_O = Eigen::Vector3d::Zero();
  };
  DeepPoint deepest_point(std::size_t link, const hands::RigidTransform& X_OL) const;
  Eigen::Vector3d touching_point(int pad, const hands::RigidTransform& X_OL) const;
  SurfacePosture evaluated(const std::vector<int>& pads,
                           const hands::HandConfiguration& configuration, HandMotion& motion,
                           NormalEquations& equations) const;

  const FittingHand& hand_;
  const ObjectModel& object_;
  const NearestPatches& nearest_;  ///< Of all patches.
  const NearestPatches& places_;   ///< Of those on which pads may lie.
  const HandMotion motion_;
  std::vector<std::vector<Eigen::Vector3d>> pad_points_L_;   ///< Per pad.
  std::vector<std::vector<Eigen::Vector3d>> link_points_L_;  ///< Per link.
};

}  // namespace graspfit::grasp::internal
