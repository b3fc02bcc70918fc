#pragma once

#include <Eigen/Core>
#include <vector>

namespace graspfit::geometry::internal {

/// Distance of `center` from the border of the convex hull of the supporting corners, all projected
/// along `up` [m]; negative outside, 0 where they span no area.
double support_margin(const std::vector<Eigen::Vector3d>& support, const Eigen::Vector3d& up,
                      const Eigen::Vector3d& center);

}  // namespace graspfit::geometry::internal
