#pragma once

#include <Eigen/Core>
#include <span>

#include "graspfit/geometry/convex_polytope.hpp"

namespace graspfit::geometry {

/// The Minkowski sum of convex polytopes, each the hull of the columns of a matrix: the set of all
/// sums of one point of each polytope. It is built by adding one summand after the other and
/// keeping the vertices of the hull of each partial sum.
///
/// The result is approximate: points are rounded to a grid of at least 2^-53 of the largest
/// coordinate times the number of summands; sums on that grid are exact, and so is their hull. The
/// function is meant for few points: the sum of k summands of n vertices in d dimensions has up to
/// the order of (k n)^(d−1) vertices, and is found from n times as many points. In 6-D two pyramids
/// over octagons are a matter of milliseconds, three may be out of reach; `minkowski_sum_inradius`
/// needs no such sum.
/// @throws InvalidInput without summands, and unless all have as many rows, 2 to 6, at least one
/// column, and are finite.
ConvexPolytope minkowski_sum(std::span<const Eigen::MatrixXd> summands);

/// When `minkowski_sum_inradius` may stop.
struct MinkowskiInradiusOptions {
  double relative_gap = 1e-12;  ///< The search stops at this ratio of the gap between the bounds to
                                ///< the upper bound, ≥ 0.
  int max_points = 1000;  ///< The search stops after the round in which it has examined so many
                          ///< points of the sum, ≥ 1: a budget of work. In practice tens to a few
                          ///< hundred suffice.
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// Bounds of the radius of the largest ball around the origin in a sum of polytopes.
struct InradiusBounds {
  double lower = 0.0;
  double upper = 0.0;  ///< Equal to `lower` up to `relative_gap`, unless `max_points` was reached
                       ///< or what is left is rounding.
  Eigen::VectorXd direction;  ///< Unit direction in which the sum's support function is `upper`;
                              ///< empty where both bounds are 0.
  int num_points = 0;         ///< Number of points of the sum that were examined.
};

/// Bounds of the radius of the largest ball around the origin in the Minkowski sum of summands that
/// all hold the origin, without forming the s^k points of the sum of k summands of s points: the
/// support function of the sum is the sum of the summands' support functions, and a polytope of
/// some points of the sum grows where its boundary is nearest to the origin, until the boundary of
/// the sum itself is as near there [Zheng 2013].
///
/// `lower` is the inradius of the hull of points of the sum, found exactly but for one rounding;
/// `upper` the sum's support function in a direction. Rounding adds about 1e-15 to each. Both are 0
/// where the origin is on the boundary of the sum.
///
/// Every summand counts as the hull of its columns and the origin. Cost: that of some tens of
/// hulls.
/// @throws InvalidInput for bad options, and as `minkowski_sum`.
InradiusBounds minkowski_sum_inradius(std::span<const Eigen::MatrixXd> summands,
                                      const MinkowskiInradiusOptions& options = {});

}  // namespace graspfit::geometry
