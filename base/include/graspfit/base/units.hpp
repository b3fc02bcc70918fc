#pragma once

#include <numbers>

/// \file
/// The code computes in meters and radians; people and files may use other units.

namespace graspfit::base {

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
inline constexpr double kMetersPerMillimeter = 1e-3;

}  // namespace graspfit::base
