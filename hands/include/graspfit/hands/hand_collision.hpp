#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/hands/forward_kinematics.hpp"

namespace graspfit::hands {

/// The link meshes of a hand, prepared once for collision tests.
///
/// A link is the solid that its mesh bounds; what a reader added to close an open mesh counts as
/// part of it (its findings say what and how much). Touching counts as intersecting. Links without
/// faces touch nothing.
class HandCollision {
 public:
  explicit HandCollision(const HandModel& model);

  /// The solid of one link in its own frame; empty for a link without faces.
  const std::optional<geometry::MeshQuery>& link_solid(int link) const { return links_[link]; }

  /// A deepest overlap and where it is. Of pairs equally deep, the first by link_a, then link_b.
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

  /// Hand against object, all links. `X_OL` from forward kinematics.
  Result against_object(const geometry::MeshQuery& object,
                        const std::vector<RigidTransform>& X_OL) const;

  /// Link against link, exclusions of the model left out.
  Result against_self(const std::vector<RigidTransform>& X_OL) const;

  /// Whether some link overlaps another, exclusions left out, by more than `depth` [m] > 0: true is
  /// certain, false may be wrong by half of it. Much cheaper than a depth where they do.
  bool overlaps_self(const std::vector<RigidTransform>& X_OL, double depth) const;

 private:
  /// Calls `visit(a, b, X_AB)` for pairs whose boxes are not apart, until it returns false.
  template <class Visit>
  void for_each_near_pair(const std::vector<RigidTransform>& X_OL, const Visit& visit) const;

  HandModel model_;
  std::vector<std::optional<geometry::MeshQuery>> links_;  ///< Empty for links without faces.
  std::vector<Eigen::AlignedBox3d> boxes_;                 ///< Of the link meshes, in L.
};

}  // namespace graspfit::hands
