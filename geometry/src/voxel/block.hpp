#pragma once

#include <Eigen/Core>

namespace graspfit::geometry::internal {

/// Calls visit(p) for all lattice points p from `low` to `high`, both included, x fastest.
template <typename Visit>
void for_each_in_block(const Eigen::Vector3i& low, const Eigen::Vector3i& high,
                       const Visit& visit) {
  for (int k = low[2]; k <= high[2]; ++k) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int i = low[0]; i <= high[0]; ++i) visit(Eigen::Vector3i(i, j, k));
    }
  }
}

}  // namespace graspfit::geometry::internal
