#pragma once

#include <Eigen/Core>

namespace graspfit::grasp::internal {

/// The x that minimizes ‖A x − b‖ subject to G x ≥ h, for an A of full column rank. Approximate, to
/// rounding; small violations of that size are possible. If no x meets all rows, something that
/// violates some: test it (h ≤ 0 allows x = 0).
///
/// By QR factorization of A the least distance problem, that by nonnegative least squares of its
/// dual [Lawson & Hanson 1974, ch. 23].
Eigen::VectorXd constrained_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                          const Eigen::MatrixXd& g, const Eigen::VectorXd& h);

}  // namespace graspfit::grasp::internal
