#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>
#include <string>
#include <string_view>

#include "graspfit/base/errors.hpp"
#include "graspfit/contact/contact.hpp"

namespace graspfit::contact::internal {

/// Normals may differ from unit length by this much, because they come from rounded arithmetic.
inline constexpr double kUnitLengthTolerance = 1e-6;

inline void require_unit(std::string_view where, const Eigen::Vector3d& normal) {
  if (!(std::abs(normal.norm() - 1.0) <= kUnitLengthTolerance)) {
    throw base::InvalidInput(std::string(where) + ": a normal must be unit, its length is " +
                             std::to_string(normal.norm()));
  }
}

inline void require_finite(std::string_view where, std::span<const Contact> contacts,
                           const Eigen::Vector3d& reference_point) {
  bool is_finite = reference_point.allFinite();
  for (const Contact& contact : contacts) is_finite = is_finite && contact.point_O.allFinite();
  if (!is_finite) {
    throw base::InvalidInput(std::string(where) +
                             ": contact points and the reference point must be finite");
  }
}

}  // namespace graspfit::contact::internal
