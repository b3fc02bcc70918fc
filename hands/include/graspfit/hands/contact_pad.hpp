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

/// A surface of one link that is meant to touch objects. It is flat, or it bulges from a flat base
/// like a fingertip.
///
/// The pad frame C has its origin in the pad's plane, z pointing out of the link toward the touched
/// object, and x and y in the plane. The outline bounds the pad as seen along z; for both kinds of
/// pads, distances from the pad's border are measured in the plane.
struct ContactPad {
  std::string name;
  int link = -1;
  std::optional<int> finger;  ///< Index of its finger; empty: the palm's pad.
  RigidTransform X_LC = RigidTransform::Identity();  ///< Pad frame in the link's frame.
  /// Convex polygon in C's x-y plane, counter-clockwise [m].
  std::vector<Eigen::Vector2d> outline;
  /// Corners of a bulging surface over the outline, in C [m]: every one at z ≥ 0 inside the outline
  /// seen along z, and in convex position together with the outline's corners at z = 0. The pad is
  /// the upper side of the hull of both. Empty: the pad is flat.
  std::vector<Eigen::Vector3d> surface;
  /// Facets of a bulging pad's upper side as half-spaces whose normals have z > 0, as the reader
  /// computes them with `surface_planes`. Empty: the pad is flat.
  std::vector<geometry::HalfSpace> planes;
  /// Explicit thickness of the clip volume [m]; empty: the planner chooses it.
  std::optional<double> clip_thickness;
};

/// Area of the pad's outline [m²].
double pad_area(const ContactPad& pad);

/// Distance of a point of the pad's plane (in C's x, y) from the outline [m]; 0 outside it.
double boundary_distance(const ContactPad& pad, const Eigen::Vector2d& point_C);

/// Largest value of `boundary_distance` over the pad: the outline's inradius [m]. Rounded.
double largest_boundary_distance(const ContactPad& pad);

/// Half-spaces with unit normals of those facets of the convex hull of the outline (at z = 0) and
/// the surface's points whose normals have z > 0; coplanar facets give one half-space. Empty for a
/// flat pad. The hull's facets are exact, their planes are rounded.
std::vector<geometry::HalfSpace> surface_planes(const ContactPad& pad);

/// Height of a point over the pad's surface along z of C [m], negative behind it. Beside the
/// outline it is the height over the surface's outermost facets, extended.
double height_over_pad(const ContactPad& pad, const Eigen::Vector3d& point_C);

/// Height of the pad's highest point over its plane [m]; 0 for a flat pad.
double pad_height(const ContactPad& pad);

/// The contact point of the pad, in C: the point that is brought to an object. It lies on the pad's
/// surface over the origin of the pad's frame. For a flat pad, and where the surface does not reach
/// over the origin, it is the origin itself. Rounded.
Eigen::Vector3d pad_contact_point_C(const ContactPad& pad);

/// On a flat pad that is longer than wide, the point this share of the way from its contact point
/// to the pad's end that lies farther from the origin of the link's frame, the fingertip's mostly;
/// on others the contact point. In C. Share 1 is 2 mm inside the outline.
Eigen::Vector3d pad_point_toward_end_C(const ContactPad& pad, double share);

/// The paper's clip volume in frame C, as half-spaces: the pad's surface offset by `thickness`
/// (> 0, else InvalidInput) along its normal. For a flat pad it is the prism over the outline; for
/// a bulging pad it is the hull of the surface and of the surface moved by `thickness` along z. The
/// volume includes the bulge itself, where no object gets without entering the link.
geometry::ConvexVolume clip_volume_C(const ContactPad& pad, double thickness);

/// The clip volume as a closed mesh with outward normals in frame C, for display. Its vertices are
/// the corners of the pad, then the same corners moved by `thickness` along z, without those that
/// are no corners of the volume. @throws as `clip_volume_C`.
TriangleMesh clip_volume_mesh_C(const ContactPad& pad, double thickness);

/// A convex volume given in the pad's frame C, expressed in a frame A in which C has pose `X_AC`.
geometry::ConvexVolume transformed(const geometry::ConvexVolume& volume_C,
                                   const RigidTransform& X_AC);

}  // namespace graspfit::hands
