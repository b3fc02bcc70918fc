#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "graspfit/grasp/fitting_hand.hpp"
#include "graspfit/grasp/object_model.hpp"
#include "graspfit/grasp/surroundings.hpp"
#include "graspfit/hands/hand_configuration.hpp"
#include "object/nearest_places.hpp"
#include "scene/hand_motion.hpp"

namespace graspfit::grasp::internal {

/// A posture in which pads lie on the object, at the level of its places.
struct SurfacePosture {
  hands::HandConfiguration configuration;
  std::vector<hands::RigidTransform> X_OL;
  std::vector<std::int32_t> places;  ///< Per pad, the place nearest to where it touches.
  double largest_gap = 0.0;          ///< Of a pad's contact point from its place [m].
  double largest_lean = 0.0;         ///< Of a pad against the normal of its place [rad].
  double largest_depth = 0.0;        ///< Of a link's point below its place, 0 if none is [m].
};

/// Lower bounds of an object's distance map in whole voxels, for many questions: look-ups of bytes.
class CoarseDistances {
 public:
  explicit CoarseDistances(const geometry::SignedDistanceMap& map);

  /// Not above the map's value at a position from the lattice's origin [voxels], but 0 or more; at
  /// most 255.
  int at(const Eigen::Array3f& position) const {
    const Eigen::Array3i voxel = position.max(0.0F).min(last_voxel_).cast<int>();
    return values_[(voxel * strides_).sum()];
  }

 private:
  Eigen::Array3f last_voxel_;
  Eigen::Array3i strides_;
  std::vector<std::uint8_t> values_;
};

/// Lays the contact points of `pads` onto the surface near where they are at `start`, and the pads
/// flat there, while links leave the object and the table: damped Gauss-Newton steps of palm and
/// joints on the object's places and its distance map. Approximate: to a fraction of a voxel;
/// nothing is decided exactly here.
class SurfaceSearch {
 public:
  /// Refers to hand, object and its places, the nearest of all of these and of those on which pads
  /// may lie, and to the surroundings, of which only the table counts.
  SurfaceSearch(const FittingHand& hand, const ObjectModel& object,
                const std::vector<SurfacePlace>& places, const NearestPlaces& nearest,
                const NearestPlaces& nearest_for_pads, const SurroundingsCollision& surroundings);

  /// Whether pads on these places would be worth the work.
  using IsWorthIt = std::function<bool(const std::vector<std::int32_t>& places)>;

  /// By `lift` [m], at most about a voxel, pads and links are kept farther off. A posture is left
  /// as it is after some steps if its places are not worth more of them.
  SurfacePosture lay(const std::vector<int>& pads, const hands::HandConfiguration& start,
                     double lift = 0.0, const IsWorthIt& is_worth_it = {}) const;

 private:
  struct Wish;
  struct Evaluated;
  class NormalEquations;
  /// n · p = offset, of a place.
  struct Plane {
    Eigen::Vector3f normal;
    float offset;
  };
  /// Points of a link that lie near each other.
  struct PointGroup {
    Eigen::Vector3f center_L = Eigen::Vector3f::Zero();
    float radius = 0.0F;  ///< [m]
    std::vector<Eigen::Vector3f> points_L;
  };
  struct DeepPoint {
    double depth = -std::numeric_limits<double>::infinity();  ///< [m]
    Eigen::Vector3d point_O = Eigen::Vector3d::Zero();
    Eigen::Vector3d outward_O = Eigen::Vector3d::Zero();
  };
  static std::vector<PointGroup> groups_of(const std::vector<Eigen::Vector3d>& points_L,
                                           double voxel_size);
  void find_neighbors();
  std::optional<Wish> overlap(int a, int b, const std::vector<hands::RigidTransform>& X_OL) const;
  double height(std::int32_t place, const Eigen::Vector3d& point_O) const;
  std::int32_t place_at(const Eigen::Vector3d& point_O) const;
  DeepPoint deepest_point(int link, const hands::RigidTransform& X_OL, double lift) const;
  Eigen::Vector3d touching_point(int pad, const hands::RigidTransform& X_OL) const;
  Evaluated evaluated(const std::vector<int>& pads, const hands::HandConfiguration& configuration,
                      double lift, double most) const;

  const FittingHand& hand_;
  const ObjectModel& object_;
  const std::vector<SurfacePlace>& places_;
  const NearestPlaces& nearest_;           ///< Of all places with a normal.
  const NearestPlaces& nearest_for_pads_;  ///< Of those on which pads may lie.
  const SurroundingsCollision& surroundings_;
  const CoarseDistances distances_;
  const MotionEntries entries_;
  std::vector<Plane> planes_;                               ///< Per place.
  std::vector<std::vector<Eigen::Vector3d>> pad_points_L_;  ///< Per pad.
  std::vector<std::vector<PointGroup>> groups_;             ///< Per link.
  std::vector<std::pair<int, int>> neighbors_;              ///< Links that are kept apart.
};

}  // namespace graspfit::grasp::internal
