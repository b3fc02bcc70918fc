#pragma once

#include <Eigen/Core>
#include <vector>

namespace graspfit::grasp::internal {

/// The x that minimizes ‖A x − b‖ subject to G x ≥ h, for an A of full column rank. Approximate, to
/// rounding; small violations of that size are possible. If no x meets all rows, something that
/// violates some: test it (h ≤ 0 allows x = 0).
///
/// By QR factorization of A the least distance problem, that by nonnegative least squares of its
/// dual [Lawson & Hanson 1974, ch. 23].
Eigen::VectorXd constrained_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                          const Eigen::MatrixXd& g, const Eigen::VectorXd& h);

/// The same problem, gathered row by row.
class ConstrainedRows {
 public:
  /// row · x is to be `value`.
  void want(const Eigen::RowVectorXd& row, double value, double weight);
  /// row · x must be at least `least`.
  void require(const Eigen::RowVectorXd& row, double least);
  /// Limits that cannot all be met at once, up to `slack`, ask for no more than that nothing gets
  /// worse.
  Eigen::VectorXd solve(double slack) const;

 private:
  std::vector<Eigen::RowVectorXd> rows_, limits_;
  std::vector<double> values_, least_;
};

}  // namespace graspfit::grasp::internal
