#pragma once

#include <numbers>

/// \file
/// The code computes in meters and radians; people and files may use other units.

namespace graspfit::base {

/// A quotient by one of these and a product with the other may differ in the last digit.
inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
inline constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
inline constexpr double kMetersPerMillimeter = 1e-3;

}  // namespace graspfit::base
