#pragma once

#include <span>
#include <string>

#include "graspfit/contact/contact.hpp"
#include "graspfit/contact/wrench_convention.hpp"

namespace graspfit::contact {

/// ε where each contact is bounded by itself, with certified bounds.
struct LInfinityEpsilon {
  double lower = 0.0;  ///< The true value is at least this and at most `upper`; they differ by
  double upper = 0.0;  ///< 1e-9 of it at most, unless a thousand points did not suffice (contacts
                       ///< as regular as a cube's six faces: 1e-3 or so).
  int num_points = 0;  ///< Vertices of the wrench space that were looked at.
};

/// What ε (L∞) in a convention depends on, in one line: as `describe`, but with this norm.
std::string describe_linf(const WrenchConvention& convention);

/// Radius of the largest ball around the origin in the wrench space whose contacts each press with
/// at most one: the Minkowski sum of the hulls of the origin and each contact's cone edges [Ferrari
/// & Canny 1992]. At least ε (L1), at most as many times that as there are contacts.
///
/// Zero without closure, since that space always holds the origin: `options.outside` and
/// `options.norm` do not count. Dimensionless. By `geometry::minkowski_sum_inradius`, not from
/// the s^k sums of edges: 25 ms for three contacts with eight edges, 75 ms for five, on a loaded
/// machine.
/// @throws InvalidInput as `contact_wrenches`.
LInfinityEpsilon epsilon_linf(std::span<const Contact> contacts,
                              const WrenchConvention& convention);

}  // namespace graspfit::contact
