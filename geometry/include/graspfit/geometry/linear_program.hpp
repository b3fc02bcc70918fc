#pragma once

#include <Eigen/Core>

#include "graspfit/base/floating_point.hpp"

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
  Eigen::VectorXd x;   ///< A vertex of the feasible set where that value is attained; empty unless
                       ///< the outcome is Optimal.
};

/// The largest value of objectiveᵀ x subject to a x = b, x ≥ 0.
///
/// The outcome and the sign of the value are exact for the given doubles; value and x are accurate
/// to a few units in the last place. Which of several optimal vertices is found is not specified,
/// but it is the same for the same input. The solver is CGAL's simplex method in exact arithmetic
/// [Gärtner & Schönherr 2000] with Bland's rule, which always terminates. It is meant for few
/// constraints: seven constraints and fifty unknowns take milliseconds.
/// @throws InvalidInput unless `a` has as many rows as `b` and as many columns, one or more, as
/// `objective`, and all are finite.
LinearProgramSolution maximize_linear(const Eigen::Ref<const Eigen::VectorXd>& objective,
                                      const Eigen::Ref<const Eigen::MatrixXd>& a,
                                      const Eigen::Ref<const Eigen::VectorXd>& b);

}  // namespace graspfit::geometry
