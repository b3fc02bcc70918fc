#pragma once

#include <Eigen/Core>
#include <vector>

#include "graspfit/contact/grasp_wrench_space.hpp"

namespace graspfit::grasp::internal {

/// A quick upper bound of ε: of some unit loads the one that contacts withstand least.
class WeakestLoad {
 public:
  WeakestLoad();

  /// The least value of the support function of the convex hull of `wrenches` (at least one column)
  /// over unit loads that are drawn once, and over others near the least of them, by subgradient
  /// steps. Where the hull holds the origin it is at least ε, the least over all loads; below zero
  /// the hull surely leaves the origin out, to rounding. Cost: some microseconds.
  double withstood(const contact::Wrenches& wrenches) const;

 private:
  std::vector<Eigen::Matrix<double, 6, 1>> loads_;
};

}  // namespace graspfit::grasp::internal
