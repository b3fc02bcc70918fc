#include "methods/firmness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "graspfit/contact/epsilon_bound.hpp"
#include "graspfit/geometry/angle.hpp"

namespace graspfit::grasp::internal {
namespace {

constexpr double kShareOfForce = 0.3;

}  // namespace

double firmness(const contact::Wrenches& wrenches, double enough) {
  const double epsilon = contact::epsilon_bound(wrenches, enough);
  if (epsilon <= enough || epsilon <= 0.0) return epsilon;
  return std::min(epsilon, kShareOfForce * contact::least_force(wrenches, enough / kShareOfForce));
}

double firmness(std::span<const contact::Contact> contacts, const contact::WrenchObject& object,
                double friction) {
  if (contacts.size() == 2) return firmness_of_pinch(contacts[0], contacts[1], friction);
  return firmness(
      contact::contact_wrenches(contacts, contact::wrench_convention(contact::WrenchTool::Graspfit,
                                                                     object, contacts, friction)),
      -std::numeric_limits<double>::infinity());
}

double firmness_friction(const PlannerOptions& options) {
  return 0.5 * (options.friction + options.squeeze_friction);
}

double firmness_of_pinch(const contact::Contact& a, const contact::Contact& b, double friction) {
  const Eigen::Vector3d line = b.point_O - a.point_O;
  if (line.isZero(0.0)) return -std::numeric_limits<double>::infinity();
  const double lean = std::max(geometry::angle_between(a.inward_normal_O, line),
                               geometry::angle_between(b.inward_normal_O, -line));
  return lean < 0.5 * std::numbers::pi ? friction - std::tan(lean) : -lean;
}

}  // namespace graspfit::grasp::internal
