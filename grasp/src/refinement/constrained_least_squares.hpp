#pragma once

#include <Eigen/Core>
#include <vector>

namespace graspfit::grasp::internal {

/// The x that minimizes ‖A x − b‖ subject to G x ≥ h, for an A of full column rank. Approximate, to
/// rounding; small violations of that size are possible. If no x meets all rows of G x ≥ h, the
/// result violates some of them: the caller has to test it (with h ≤ 0, x = 0 meets all).
///
/// The QR factorization of A gives a least distance problem, which is solved by nonnegative least
/// squares of its dual [Lawson & Hanson 1974, ch. 23].
Eigen::VectorXd constrained_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                          const Eigen::MatrixXd& g, const Eigen::VectorXd& h);

/// The same problem, gathered row by row.
class ConstrainedRows {
 public:
  /// row · x is to be `value`.
  void want(const Eigen::RowVectorXd& row, double value, double weight);
  /// row · x must be at least `least`.
  void require(const Eigen::RowVectorXd& row, double least);
  /// The solution. Where the limits cannot all be met, up to `slack`, those that x = 0 violates
  /// only require that the violation does not grow.
  Eigen::VectorXd solve(double slack) const;

 private:
  std::vector<Eigen::RowVectorXd> rows_, limits_;
  std::vector<double> values_, least_;
};

}  // namespace graspfit::grasp::internal
