#pragma once

#include <Eigen/Core>

namespace graspfit::geometry {

/// How a linear program ended.
enum class LinearProgramOutcome {
  Optimal,
  Infeasible,  ///< No x meets the constraints.
  Unbounded,   ///< The objective has no largest value.
};

struct LinearProgramSolution {
  LinearProgramOutcome outcome = LinearProgramOutcome::Infeasible;
  double value = 0.0;  ///< Largest objective; 0 unless optimal.
  Eigen::VectorXd x;   ///< A point where it is reached, a vertex of the feasible set; empty unless
                       ///< optimal.
};

/// The largest value of objectiveᵀ x subject to a x = b, x ≥ 0.
///
/// Exact for the numbers as they are: the outcome, and the sign of the value; value and x are good
/// to a few units in the last place. Which optimal vertex is found is not specified, but the same
/// for the same input.
/// By CGAL's simplex method with exact arithmetic [Gärtner & Schönherr 2000] and Bland's rule, with
/// which it always ends: for few constraints, milliseconds for seven of them and fifty unknowns.
/// @throws InvalidInput unless `a` has as many rows as `b` and as many columns, one or more, as
/// `objective`, and all are finite.
LinearProgramSolution maximize_linear(const Eigen::Ref<const Eigen::VectorXd>& objective,
                                      const Eigen::Ref<const Eigen::MatrixXd>& a,
                                      const Eigen::Ref<const Eigen::VectorXd>& b);

}  // namespace graspfit::geometry
