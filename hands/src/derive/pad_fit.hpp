#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::hands::internal {

/// Where to search for a pad.
struct PadSearch {
  Eigen::Vector3d direction;  ///< Unit vector that the pad is to face, in the link's frame.
  Eigen::Vector3d along;      ///< The pad's x axis is to follow it; not parallel to `direction`.
  /// If several parts of the surface face `direction`, the part nearest to the line through this
  /// point along `direction` is used. Empty: the largest part is.
  std::optional<Eigen::Vector3d> center;
  double reach = 0.0;  ///< Surface farther than this from `center` is left out [m]; 0: no limit.
};

/// A pad found on a surface.
struct FittedPad {
  RigidTransform X_LC = RigidTransform::Identity();
  std::vector<Eigen::Vector2d> outline;
  std::vector<Eigen::Vector3d> surface;  ///< Empty for a flat pad.
  double area = 0.0;                     ///< Of the outline [m²].
  /// Largest distance along z between the pad and the mesh, over rays on a grid [m].
  double deviation = 0.0;
};

/// The pad of a surface that faces a direction: flat where the surface is, else a convex dome.
///
/// The surface is sampled by rays against `direction` on a grid (kNumRays along the longer side).
/// Only the first hit of a ray counts, so that of overlapping parts only the outside does; surface
/// that `others` (the rest of the same rigid body, in the same frame) hide does not count. Of the
/// parts whose normal leans by at most kMaxLean from `direction` the largest connected one is
/// taken, or the one at the search's center.
///
/// 1. Flat: if a plane holds at least kFlatShare of the part, or kFrontShare of it and no surface
///    is in front of the plane, the pad lies in the plane. Its outline is the hull of the plane's
///    mesh faces where rays find at least kFillShare of the hull's inside to be surface, else the
///    largest rectangle of the grid that is surface.
/// 2. Bulging: the outline is the hull of the part (at most kMaxCorners corners, the same fall-back
///    to a rectangle), and the dome the hull of mesh points, added one after the other where the
///    mesh stands out most, until no point does by more than kDomeTolerance or kMaxPlanes is
///    reached. Dents and hollows are bridged; where the pad then stands off the mesh by more than
///    kMaxBridge, less of the part is taken, around its center.
///
/// The result is empty if no surface faces the direction, and approximate to the spacing of the
/// grid.
std::optional<FittedPad> fit_pad(const geometry::MeshQuery& link,
                                 const std::vector<geometry::MeshQuery>& others,
                                 const PadSearch& search);

}  // namespace graspfit::hands::internal
