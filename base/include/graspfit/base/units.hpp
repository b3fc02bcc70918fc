#pragma once

#include <numbers>

/// \file
/// Everything inside is in meters and radians; people and files may use others.

namespace graspfit::base {

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
inline constexpr double kMetersPerMillimeter = 1e-3;

}  // namespace graspfit::base
