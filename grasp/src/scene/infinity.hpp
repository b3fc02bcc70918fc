#pragma once

#include <limits>

namespace graspfit::grasp::internal {

/// Initial value of searches for the least distance, and the distance to a body that does not
/// exist.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace graspfit::grasp::internal
