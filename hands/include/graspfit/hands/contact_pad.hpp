#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/geometry/convex_clip.hpp"
#include "graspfit/geometry/rigid_transform.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::hands {

using geometry::RigidTransform;
using geometry::TriangleMesh;

/// A surface meant to touch, on one link: flat, or bulging from a flat base like a fingertip.
///
/// Pad frame C: origin in the pad's plane, z leaving the link toward what it touches, x and y in
/// the plane. The outline bounds the pad seen along z; distances from the pad's border are measured
/// in the plane for both kinds.
struct ContactPad {
  std::string name;
  int link = -1;
  std::optional<int> finger;                         ///< Of the hand model; empty: the palm.
  RigidTransform X_LC = RigidTransform::Identity();  ///< Pad frame in the link's frame.
  std::vector<Eigen::Vector2d>
      outline;  ///< Convex polygon in C's x-y plane, counter-clockwise [m].
  /// Corners of a bulging surface over the outline, in C [m]: every one at z ≥ 0 inside the outline
  /// seen along z, and in convex position together with the outline's corners at z = 0. The pad is
  /// the upper side of the hull of both. Empty: the pad is flat.
  std::vector<Eigen::Vector3d> surface;
  /// That upper side's facets as half-spaces with normal z > 0, what `surface_planes` makes of
  /// outline and surface; the reader does so. Empty: the pad is flat.
  std::vector<geometry::HalfSpace> planes;
  /// Explicit thickness of the clip volume [m]; empty: the planner's rule.
  std::optional<double> clip_thickness;
};

/// Area of the pad's outline [m²].
double pad_area(const ContactPad& pad);

/// Distance of a point of the pad's plane (in C's x, y) from the outline [m]; 0 outside it.
double boundary_distance(const ContactPad& pad, const Eigen::Vector2d& point_C);

/// Largest value of `boundary_distance` over the pad: the outline's inradius [m]. Rounded.
double largest_boundary_distance(const ContactPad& pad);

/// Planes of the facets with normal z > 0 of the hull of the outline (z = 0) and the surface's
/// points, coplanar ones once, unit normals; empty for a flat pad. The hull's facets are exact, the
/// planes rounded.
std::vector<geometry::HalfSpace> surface_planes(const ContactPad& pad);

/// Height of a point over the pad's surface along z of C [m], negative behind it. Beside the
/// outline: over the surface's outermost facets, extended.
double height_over_pad(const ContactPad& pad, const Eigen::Vector3d& point_C);

/// Height of the pad's highest point over its plane [m]; 0 for a flat one.
double pad_height(const ContactPad& pad);

/// The point of the pad that is meant to touch, in C: over the origin of the pad's frame, on its
/// surface; the origin itself of a flat pad, and where the surface does not reach over it. Whatever
/// is to be brought to an object is this point. Rounded.
Eigen::Vector3d pad_contact_point_C(const ContactPad& pad);

/// The paper's clip volume in frame C, the pad's surface offset by `thickness` along its normal
/// (> 0, else InvalidInput), as half-spaces: of a flat pad the prism over the outline, of a bulging
/// one the hull of the surface and of the same moved by `thickness` along z. The bulge itself is
/// part of it: no object gets there without entering the link.
geometry::ConvexVolume clip_volume_C(const ContactPad& pad, double thickness);

/// The clip volume as a closed outward mesh in frame C, for showing it: corners of the pad, then
/// the same moved by `thickness` along z. @throws as `clip_volume_C`.
TriangleMesh clip_volume_mesh_C(const ContactPad& pad, double thickness);

/// The same volume in a frame A in which the pad's frame has pose `X_AC`.
geometry::ConvexVolume transformed(const geometry::ConvexVolume& volume_C,
                                   const RigidTransform& X_AC);

}  // namespace graspfit::hands
