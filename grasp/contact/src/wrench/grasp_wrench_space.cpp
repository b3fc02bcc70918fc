#include "graspfit/contact/grasp_wrench_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contacts/contact_check.hpp"
#include "graspfit/geometry/dyadic_grid.hpp"
#include "wrench/nearest_wrench.hpp"

namespace graspfit::contact {
namespace {

using geometry::Containment;
using geometry::ConvexPolytope;

/// Rounding error of a product of two vectors of six, relative to the product of their lengths: 6
/// roundings of 2^-53, and 2 to spare.
constexpr double kProductError = 8.0 * 0x1p-53;
constexpr double kLeastProduct = 0x1p-1000;  ///< Smaller ones may be off by underflow.

bool has_origin_inside(const ConvexPolytope& hull) {
  return hull.containment(Wrench::Zero()) == Containment::Inside;
}

}  // namespace

Wrenches contact_wrenches(std::span<const Contact> contacts, const WrenchConvention& convention) {
  const WrenchSpaceOptions& options = convention.options;
  options.validate();
  internal::require_finite("contact_wrenches", contacts, convention.reference_point_O);
  const double normal_force = options.force_scaling == ForceScaling::UnitNormal
                                  ? options.force_limit
                                  : options.force_limit / std::hypot(1.0, options.friction);
  Wrenches wrenches(6, contacts.size() * static_cast<std::size_t>(options.num_cone_edges));
  Eigen::Index column = 0;
  for (const Contact& contact : contacts) {
    const FrictionCone cone = friction_cone(contact.inward_normal_O, options.friction);
    const Eigen::Matrix3Xd edges = cone_edges(cone, options.num_cone_edges);
    for (const auto& edge : edges.colwise()) {
      wrenches.col(column++) = wrench(normal_force * edge, contact.point_O,
                                      convention.reference_point_O, *options.torque_scale);
    }
  }
  if (wrenches.cols() == 0) return wrenches;
  // Wrenches are rounded to multiples of the last bit of the largest entry.
  const double largest = wrenches.cwiseAbs().maxCoeff();
  return geometry::rounded_to_grid(wrenches, geometry::power_above(largest) - 52);
}

GraspWrenchSpace grasp_wrench_space(std::span<const Contact> contacts,
                                    const WrenchConvention& convention) {
  Wrenches wrenches = contact_wrenches(contacts, convention);
  ConvexPolytope hull(wrenches);
  return {convention, std::move(wrenches), std::move(hull)};
}

GraspWrenchSpace grasp_wrench_space(std::span<const Contact> contacts,
                                    const Eigen::Vector3d& reference_point_O,
                                    const WrenchSpaceOptions& options) {
  return grasp_wrench_space(contacts, {reference_point_O, options, std::nullopt});
}

WrenchQuality wrench_quality(const GraspWrenchSpace& space) {
  return {.epsilon = epsilon_quality(space),
          .volume = space.hull.volume(),
          .is_force_closure = is_force_closure(space),
          .rank = space.hull.rank(),
          .convention = space.convention};
}

double epsilon_quality(const GraspWrenchSpace& space) {
  const double inradius = space.hull.inradius(Wrench::Zero());
  if (inradius >= 0.0) return inradius;
  switch (space.convention.options.outside) {
    case OutsideValue::MinusOne:
      return -1.0;
    case OutsideValue::Signed:
      return inradius;
    case OutsideValue::Zero:
      break;
  }
  return 0.0;
}

double signed_epsilon(std::span<const Contact> contacts, const WrenchObject& object,
                      double friction) {
  if (contacts.empty()) return -std::numeric_limits<double>::infinity();
  WrenchConvention convention = wrench_convention(WrenchTool::Graspfit, object, contacts, friction);
  convention.options.outside = OutsideValue::Signed;
  return epsilon_quality(grasp_wrench_space(contacts, convention));
}

bool is_force_closure(const GraspWrenchSpace& space) { return has_origin_inside(space.hull); }

bool is_force_closure(const Wrenches& wrenches) {
  if (!wrenches.allFinite()) throw base::InvalidInput("is_force_closure: a wrench is not finite");
  return wrenches.cols() > 6 && !is_surely_no_force_closure(wrenches) &&
         has_origin_inside(ConvexPolytope(wrenches));
}

bool is_surely_no_force_closure(const Wrenches& wrenches) {
  if (wrenches.cols() == 0) return true;
  const double longest = wrenches.colwise().norm().maxCoeff();
  return internal::near_wrench(wrenches,
                               [&](const Wrench& point, double product) {
                                 return product > kLeastProduct &&
                                        product > kProductError * point.norm() * longest;
                               })
      .is_enough;
}

}  // namespace graspfit::contact
