#pragma once

#include <Eigen/Core>
#include <span>

#include "graspfit/contact/contact.hpp"
#include "graspfit/contact/wrench.hpp"
#include "graspfit/contact/wrench_convention.hpp"
#include "graspfit/geometry/convex_polytope.hpp"

namespace graspfit::contact {

/// The wrenches that contacts can exert with bounded forces: the convex hull of the wrenches of
/// their cone edges [Ferrari & Canny 1992].
struct GraspWrenchSpace {
  WrenchConvention convention;
  Wrenches wrenches;              ///< Cone edges of contact 0, of contact 1, ...
  geometry::ConvexPolytope hull;  ///< Of `wrenches`, whose columns are its points.
};

/// Wrenches of the cone edges of all contacts, as the convention scales them. Approximate: rounded
/// to multiples of one power of two, 2^-52 of the largest component or less, so that exact
/// decisions about them are cheap.
/// @throws InvalidInput for options out of range, a normal that is not unit within 1e-6, and
/// points that are not finite.
Wrenches contact_wrenches(std::span<const Contact> contacts, const WrenchConvention& convention);

/// The space of a convention, or of options and the point that torques are about, for the own
/// convention the center of mass. No contacts span nothing: rank −1.
///
/// Cost: that of the hull, see `ConvexPolytope`: about 2 ms for three contacts with eight edges and
/// 5 ms for five. @throws InvalidInput as `contact_wrenches`.
GraspWrenchSpace grasp_wrench_space(std::span<const Contact> contacts,
                                    const WrenchConvention& convention);
GraspWrenchSpace grasp_wrench_space(std::span<const Contact> contacts,
                                    const Eigen::Vector3d& reference_point_O,
                                    const WrenchSpaceOptions& options);

/// What a grasp withstands, with the convention that the numbers depend on.
struct WrenchQuality {
  double epsilon = 0.0;           ///< See `epsilon_quality`.
  double volume = 0.0;            ///< 6-volume of the hull. Comparable at equal conventions only.
  bool is_force_closure = false;  ///< See `is_force_closure`.
  int rank = -1;                  ///< Of the hull, 6 for closure; −1 without contacts. Exact.
  WrenchConvention convention;
};
WrenchQuality wrench_quality(const GraspWrenchSpace& space);

/// Radius of the largest ball around the origin that fits in the grasp wrench space [Ferrari &
/// Canny 1992]. Dimensionless (newtons per newton of contact force).
///
/// Zero where the origin is on the boundary, so always below rank 6; `options.outside` says what
/// it is outside. Exactness: sign exact, magnitude rounded.
double epsilon_quality(const GraspWrenchSpace& space);

/// Whether the origin lies strictly within the hull of the wrenches: any load is balanced by some
/// contact forces within the linearized cones. Exact for the wrenches as they are.
///
/// Contacts that are opposite each other but for rounding have an ε of 1e-17 and may well have
/// closure in this sense. Compare ε with what matters to you.
bool is_force_closure(const GraspWrenchSpace& space);

/// The same for any wrenches, usually without a hull where the answer is no.
bool is_force_closure(const Wrenches& wrenches);

/// True means: certainly no force closure. Some load was found that no wrench works against (all
/// have a positive product with it, beyond rounding). False means nothing.
///
/// A search for the point of the hull nearest to the origin [Gilbert 1966], at most 64 steps of one
/// product per wrench: microseconds, for what rejects grasps by the thousand.
bool is_surely_no_force_closure(const Wrenches& wrenches);

}  // namespace graspfit::contact
