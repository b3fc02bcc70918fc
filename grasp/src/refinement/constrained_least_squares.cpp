#include "refinement/constrained_least_squares.hpp"

#include <Eigen/QR>

#include "graspfit/geometry/nonnegative_least_squares.hpp"

namespace graspfit::grasp::internal {

using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

namespace {

MatrixXd matrix(const std::vector<RowVectorXd>& rows) {
  MatrixXd result(std::ssize(rows), rows.front().size());
  for (int i = 0; i < std::ssize(rows); ++i) result.row(i) = rows[i];
  return result;
}

VectorXd vector(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), std::ssize(values));
}

}  // namespace

VectorXd constrained_least_squares(const MatrixXd& a, const VectorXd& b, const MatrixXd& g,
                                   const VectorXd& h) {
  const Eigen::Index n = a.cols();
  const Eigen::HouseholderQR<MatrixXd> qr(a);
  const auto r = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  const VectorXd free_part = (qr.householderQ().adjoint() * b).head(n);
  // With z = R x − Qᵀb the problem is: least ‖z‖ subject to (G R⁻¹) z ≥ h − (G R⁻¹) Qᵀb.
  const MatrixXd rows = r.transpose().solve(g.transpose()).transpose();
  const VectorXd limits = h - rows * free_part;
  VectorXd z = VectorXd::Zero(n);
  const double farthest = limits.size() == 0 ? 0.0 : limits.maxCoeff();
  if (farthest > 0.0) {
    // Lengths in units of the right sides make the last row of the dual as large as the others.
    MatrixXd dual(n + 1, g.rows());
    dual.topRows(n) = rows.transpose();
    dual.row(n) = limits.transpose() / farthest;
    VectorXd target = VectorXd::Zero(n + 1);
    target[n] = 1.0;
    const VectorXd residual = dual * geometry::nonnegative_least_squares(dual, target) - target;
    if (residual[n] != 0.0) z = -farthest * residual.head(n) / residual[n];
  }
  return r.solve(VectorXd(free_part + z));
}

void ConstrainedRows::want(const RowVectorXd& row, double value, double weight) {
  rows_.push_back(weight * row);
  values_.push_back(weight * value);
}

void ConstrainedRows::require(const RowVectorXd& row, double least) {
  limits_.push_back(row);
  least_.push_back(least);
}

VectorXd ConstrainedRows::solve(double slack) const {
  const MatrixXd a = matrix(rows_), g = matrix(limits_);
  const VectorXd b = vector(values_), h = vector(least_);
  const VectorXd x = constrained_least_squares(a, b, g, h);
  if (((g * x - h).array() >= -slack).all()) return x;
  return constrained_least_squares(a, b, g, h.cwiseMin(0.0));
}

}  // namespace graspfit::grasp::internal
