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

/// Computes the grasp wrench space in a convention, or with options and the point about which
/// torques are taken (in this project's own convention the center of mass). Without contacts the
/// space is empty: its rank is −1.
///
/// The cost is that of the hull (see `ConvexPolytope`): about 2 ms for three contacts with eight
/// edges and 5 ms for five. @throws InvalidInput as `contact_wrenches`.
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
  int rank = -1;  ///< Rank of the hull: 6 for closure, −1 without contacts. Exact.
  WrenchConvention convention;
};
WrenchQuality wrench_quality(const GraspWrenchSpace& space);

/// Radius of the largest ball around the origin that fits in the grasp wrench space [Ferrari &
/// Canny 1992]. Dimensionless (newtons per newton of contact force).
///
/// It is zero where the origin is on the boundary, so always below rank 6; `options.outside` says
/// what it is where the origin is outside. Its sign is exact, its magnitude rounded.
double epsilon_quality(const GraspWrenchSpace& space);

/// ε of contacts in this project's own convention (`WrenchTool::Graspfit`), but with a sign:
/// where the origin is outside the wrench space it is minus the largest distance from the origin to
/// the plane of a facet that cuts it off (`OutsideValue::Signed`), and 0 on the boundary. Minus
/// infinity without contacts. @throws as `contact_wrenches`.
double signed_epsilon(std::span<const Contact> contacts, const WrenchObject& object,
                      double friction);

/// Says whether the origin lies strictly within the hull of the wrenches, so that any load is
/// balanced by some contact forces within the linearized cones. The answer is exact for the
/// wrenches as they are.
///
/// Contacts that are opposite each other but for rounding have an ε of 1e-17 and may well have
/// closure in this sense. Compare ε with what matters to you.
bool is_force_closure(const GraspWrenchSpace& space);

/// Says whether any wrenches have force closure, usually without computing a hull where the answer
/// is no. @throws InvalidInput for a wrench that is not finite.
bool is_force_closure(const Wrenches& wrenches);

/// Returns true only if there is certainly no force closure: some load was found that no wrench
/// works against (all wrenches have a positive product with it, beyond rounding). False means
/// nothing.
///
/// It searches for the point of the hull nearest to the origin [Gilbert 1966], in at most 64 steps
/// of one product per wrench. This takes microseconds, for callers that reject grasps by the
/// thousand.
bool is_surely_no_force_closure(const Wrenches& wrenches);

}  // namespace graspfit::contact
