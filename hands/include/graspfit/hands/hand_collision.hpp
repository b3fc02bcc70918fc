#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <utility>
#include <vector>

#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::hands {

/// The link meshes of a hand, prepared once for collision tests.
///
/// A link is the solid that its mesh bounds; surface that a reader added to close an open mesh is
/// part of the solid (the reader's findings say what was added and how much). Touching counts as
/// intersecting. Links without faces touch nothing. All functions throw InvalidInput for poses that
/// are not finite, and for a number of poses that is not that of the links.
class HandCollision {
 public:
  explicit HandCollision(const HandModel& model);

  /// The solid of one link in its own frame; empty for a link without faces.
  const std::optional<geometry::MeshQuery>& link_solid(int link) const { return links_[link]; }

  /// The deepest overlap and the links that have it. Of several equally deep pairs it is the first
  /// by link_a, then by link_b.
  struct Result {
    bool intersects = false;    ///< Exact on the true meshes (see geometry::do_intersect).
    double depth = 0.0;         ///< Largest depth over all pairs [m]; a lower bound.
    double depth_bound = 0.0;   ///< The true depth is at most this [m].
    std::optional<int> link_a;  ///< Link of the deepest overlap; empty without one.
    std::optional<int> link_b;  ///< The other link for self-collision; empty against the object.
  };

  /// Whether one link and the object share a point. Exact, as `geometry::do_intersect`; much
  /// cheaper than a depth.
  bool link_intersects(const geometry::MeshQuery& object, int link,
                       const RigidTransform& X_OL) const;

  /// Bounds of the depth by which one link and the object overlap, as `geometry::depth_above`.
  geometry::DepthBounds link_depth_above(const geometry::MeshQuery& object, int link,
                                         const RigidTransform& X_OL, double floor,
                                         const geometry::PenetrationOptions& options) const;

  /// Collision of all links with the object. `X_OL` are the link poses from forward kinematics.
  Result against_object(const geometry::MeshQuery& object,
                        const std::vector<RigidTransform>& X_OL) const;

  /// Collision of the links with each other, without the pairs that the model excludes.
  Result against_self(const std::vector<RigidTransform>& X_OL) const;

  /// The pairs of links that share a point, the lower link first, in order, without those that the
  /// model excludes. Exact, as `geometry::do_intersect`; much cheaper than `against_self`, which
  /// finds how deep they overlap.
  std::vector<std::pair<int, int>> overlapping_pairs(const std::vector<RigidTransform>& X_OL) const;

  /// Whether some link overlaps another by more than `depth` [m] > 0, without the pairs that the
  /// model excludes. True is certain; false may be wrong by half of `depth`, or by more where
  /// `penetration` ends after its most steps. Much cheaper than `against_self` where links overlap.
  bool overlaps_self(const std::vector<RigidTransform>& X_OL, double depth) const {
    return pair_deeper_than(X_OL, depth).has_value();
  }

  /// A pair of links of which `overlaps_self` tells: `likely` if it is one, which is tested before
  /// all others, else the first in order; empty if there is none.
  std::optional<std::pair<int, int>> pair_deeper_than(
      const std::vector<RigidTransform>& X_OL, double depth,
      const std::optional<std::pair<int, int>>& likely = std::nullopt) const;

 private:
  /// Calls `visit(a, b, X_AB)` for the pairs of links whose boxes are not apart, until `visit`
  /// returns false.
  template <class Visit>
  void for_each_near_pair(const std::vector<RigidTransform>& X_OL, const Visit& visit) const;
  bool is_deeper_than(double depth, int a, int b, const RigidTransform& X_AB) const;

  HandModel model_;
  std::vector<std::optional<geometry::MeshQuery>> links_;  ///< Empty for links without faces.
  std::vector<Eigen::AlignedBox3d> boxes_;                 ///< Of the link meshes, in L.
};

}  // namespace graspfit::hands
