#pragma once

#include <span>
#include <string>

#include "graspfit/contact/contact.hpp"
#include "graspfit/contact/wrench_convention.hpp"

namespace graspfit::contact {

/// Certified bounds of ε where the force of each contact is bounded separately (norm L∞).
struct LInfinityEpsilon {
  double lower = 0.0;  ///< The true value is at least this and at most `upper`; they differ by
  double upper = 0.0;  ///< 1e-9 of it at most, unless a thousand points did not suffice (contacts
                       ///< as regular as a cube's six faces: 1e-3 or so).
  int num_points = 0;  ///< Number of vertices of the wrench space that were examined.
};

/// Describes in one line what ε (L∞) in a convention depends on: as `describe`, but with the norm
/// L∞.
std::string describe_linf(const WrenchConvention& convention);

/// Computes the radius of the largest ball around the origin in the wrench space of contacts that
/// each press with at most one. This space is the Minkowski sum of the hulls of the origin and each
/// contact's cone edges [Ferrari & Canny 1992]. The radius is at least ε (L1) and at most ε (L1)
/// times the number of contacts; it is dimensionless.
///
/// It is zero without force closure, since this wrench space always holds the origin:
/// `options.outside` has no effect. It is computed by `geometry::minkowski_sum_inradius`, not from
/// the s^k sums of edges: 25 ms for three contacts with eight edges, 75 ms for five, on a loaded
/// machine.
/// @throws InvalidInput as `contact_wrenches`.
LInfinityEpsilon epsilon_linf(std::span<const Contact> contacts,
                              const WrenchConvention& convention);

}  // namespace graspfit::contact
