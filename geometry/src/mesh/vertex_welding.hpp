#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace graspfit::geometry::internal {

/// One vertex for each position, the first with it; −0 becomes 0. Returns where each old one went.
std::vector<std::int32_t> weld_equal(std::vector<Eigen::Vector3d>& vertices);

/// In order, every vertex within `distance` (> 0) of a kept one goes to the first such; the others
/// are kept. So nothing moves by more than `distance`, and chains of close vertices do not collapse
/// into one. Returns where each old one went.
std::vector<std::int32_t> weld_near(std::vector<Eigen::Vector3d>& vertices, double distance);

}  // namespace graspfit::geometry::internal
