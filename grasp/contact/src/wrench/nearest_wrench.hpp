#pragma once

#include <algorithm>

#include "graspfit/contact/grasp_wrench_space.hpp"

namespace graspfit::contact::internal {

/// A point of the hull of some wrenches near the one nearest to the origin.
struct NearWrench {
  Wrench point;
  bool is_enough = false;  ///< Whether the search ended because it was.
};

/// Searches for the point of the hull of wrenches, at least one, that is nearest to the origin
/// [Gilbert 1966], in at most 64 steps of one product per wrench, until
/// `is_enough(point, least product of a wrench with it)`.
template <class IsEnough>
NearWrench near_wrench(const Wrenches& wrenches, const IsEnough& is_enough) {
  constexpr int kMostSteps = 64;
  NearWrench near{wrenches.rowwise().mean()};
  for (int step = 0; step < kMostSteps; ++step) {
    Eigen::Index against = 0;
    const double least = (near.point.transpose() * wrenches).minCoeff(&against);
    if (is_enough(near.point, least)) {
      near.is_enough = true;
      break;
    }
    // The next point is the one nearest to the origin on the segment to the wrench that is most
    // against it.
    const Wrench way = wrenches.col(against) - near.point;
    const double share = -near.point.dot(way) / way.squaredNorm();
    if (!(share > 0.0)) break;
    near.point += std::min(share, 1.0) * way;
  }
  return near;
}

}  // namespace graspfit::contact::internal
