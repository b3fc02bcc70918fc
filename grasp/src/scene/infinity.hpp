#pragma once

#include <limits>

namespace graspfit::grasp::internal {

/// Where a search for the nearest starts, and the distance to what is not there.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace graspfit::grasp::internal
