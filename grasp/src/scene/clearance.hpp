#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "graspfit/geometry/surface_proximity.hpp"
#include "graspfit/grasp/fitting_hand.hpp"
#include "graspfit/grasp/object_model.hpp"
#include "graspfit/grasp/surroundings.hpp"

namespace graspfit::grasp::internal {

using LinkPoses = std::vector<hands::RigidTransform>;

/// Two bodies near each other: a link, and the object, the surroundings or another link.
struct NearPoints {
  double distance = 0.0;  ///< [m]
  int link = 0;
  std::optional<int> other_link;     ///< Empty: the object or the surroundings.
  Eigen::Vector3d point_O;           ///< On the link.
  Eigen::Vector3d point_on_other_O;  ///< On the other link; else meaningless.
  Eigen::Vector3d normal_O;          ///< Unit, from the other body to the link.
};

/// Distances of a hand from all bodies that it must not touch, for many queries along a motion:
/// bounds from earlier queries make most distance computations unnecessary. Results are
/// deterministic in the sequence of queries.
class Clearance {
 public:
  Clearance(const FittingHand& hand, const ObjectModel& object,
            const SurroundingsCollision& surroundings);

  /// All near points closer than `enough` [m], in a fixed order: pieces of links against the
  /// object, links against the surroundings, links against each other.
  std::vector<NearPoints> find(const LinkPoses& X_OL, double enough);

  /// Whether no link is within `least` [m] of the object, the surroundings or another link, to the
  /// rounding of distances. Bodies that are surely farther apart, by bounds from `find`, are not
  /// measured.
  bool is_apart(const LinkPoses& X_OL, double least) const;

  /// Links that are closer than `least` to something.
  struct Blocked {
    std::vector<int> links;        ///< By the object or the surroundings.
    std::vector<int> by_own_hand;  ///< By another link.
    bool is_empty() const { return links.empty() && by_own_hand.empty(); }
  };
  Blocked blocked(const LinkPoses& X_OL, double least) const;

  /// Exact: no link shares a point with the object, the surroundings or another link.
  bool is_clear_of_world(const LinkPoses& X_OL) const;
  bool is_clear_of_itself(const LinkPoses& X_OL) const;

 private:
  /// What is known of a piece or a pair: the bodies are at least `at_least` apart in the relative
  /// pose `X`.
  struct Known {
    double at_least = 0.0;
    hands::RigidTransform X = hands::RigidTransform::Identity();
    std::optional<geometry::ProximitySeed> seed;
    bool is_known = false;
    /// Whether the last query found the bodies nearer than the distance asked for.
    bool is_near = false;
  };
  static std::optional<geometry::SurfaceProximity> nearest(Known& known,
                                                           const geometry::MeshQuery& a,
                                                           const geometry::MeshQuery& b,
                                                           const hands::RigidTransform& X,
                                                           double enough);
  static bool surely_beyond(const Known& known, const hands::RigidTransform& X,
                            const Eigen::Vector3d& center, double radius, double enough);
  double object_bound(const Eigen::Vector3d& center_O, double radius, double enough) const;

  const FittingHand& hand_;
  const ObjectModel& object_;
  const SurroundingsCollision& surroundings_;
  std::vector<std::pair<int, int>> pairs_;  ///< Links that may touch each other.
  std::vector<Eigen::Vector3d> centers_L_;  ///< Of a ball around each link.
  std::vector<double> radii_;
  std::vector<std::vector<Known>> pieces_;
  std::vector<Known> pair_known_;
};

}  // namespace graspfit::grasp::internal
