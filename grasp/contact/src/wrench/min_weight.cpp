#include "graspfit/contact/min_weight.hpp"

#include <Eigen/SVD>

#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/dyadic_grid.hpp"
#include "graspfit/geometry/linear_program.hpp"

namespace graspfit::contact {
namespace {

using Eigen::Index;

/// Singular values below this share of the largest are rounding.
constexpr double kRankTolerance = 1e-9;

/// Rounds wrenches to a grid on which sums of all columns are exact.
Wrenches on_grid_of_sums(const Wrenches& wrenches) {
  const double bound = wrenches.cwiseAbs().maxCoeff() * static_cast<double>(wrenches.cols());
  return geometry::rounded_to_grid(wrenches, geometry::power_above(bound) - 52);
}

}  // namespace

MinWeight min_weight(const Wrenches& wrenches) {
  MinWeight result;
  const Index count = wrenches.cols();
  if (count == 0) return result;
  if (!wrenches.allFinite()) throw base::InvalidInput("min_weight: wrenches must be finite");
  const Eigen::VectorXd singular =
      Eigen::JacobiSVD<Eigen::MatrixXd>(Eigen::MatrixXd(wrenches)).singularValues();
  for (const double value : singular) {
    if (value > kRankTolerance * singular[0]) ++result.rank;
  }
  if (singular.size() == 6) result.smallest_singular = singular[5];

  // α_i = l + β_i with β_i ≥ 0, and l the difference of two unknowns that are not negative.
  const Wrenches rounded = on_grid_of_sums(wrenches);
  Eigen::MatrixXd constraints(7, count + 2);
  constraints.topLeftCorner(6, count) = rounded;
  constraints.row(6).head(count).setOnes();
  // The sum needs a vector of its own: written straight into a column at an odd offset, Eigen 3.4
  // reads pairs of rows from odd offsets, and its assertions take those for misaligned.
  const Wrench sum = rounded.rowwise().sum();
  constraints.col(count) << sum, static_cast<double>(count);
  constraints.col(count + 1) = -constraints.col(count);
  Eigen::VectorXd objective = Eigen::VectorXd::Zero(count + 2);
  objective[count] = 1.0;
  objective[count + 1] = -1.0;
  const geometry::LinearProgramSolution solution =
      geometry::maximize_linear(objective, constraints, Eigen::VectorXd::Unit(7, 6));
  if (solution.outcome != geometry::LinearProgramOutcome::Optimal) return result;
  result.weight = solution.value;
  result.normalized = solution.value * static_cast<double>(count);
  return result;
}

}  // namespace graspfit::contact
