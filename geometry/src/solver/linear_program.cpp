#include "graspfit/geometry/linear_program.hpp"

// The solver's own checks of every step take longer than the steps.
#define CGAL_QP_NO_ASSERTIONS
#include <CGAL/Gmpzf.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>
#include <CGAL/QP_options.h>

#include <limits>
#include <string>

#include "graspfit/base/errors.hpp"

namespace graspfit::geometry {

using Eigen::Index;

LinearProgramSolution maximize_linear(const Eigen::Ref<const Eigen::VectorXd>& objective,
                                      const Eigen::Ref<const Eigen::MatrixXd>& a,
                                      const Eigen::Ref<const Eigen::VectorXd>& b) {
  if (objective.size() == 0 || a.cols() != objective.size() || a.rows() != b.size() ||
      !objective.allFinite() || !a.allFinite() || !b.allFinite()) {
    throw base::InvalidInput("maximize_linear: the matrix is " + std::to_string(a.rows()) + " x " +
                             std::to_string(a.cols()) + ", must be finite and " +
                             std::to_string(b.size()) + " x " + std::to_string(objective.size()) +
                             ", at least one column, as the right side and the objective");
  }
  CGAL::Quadratic_program<double> program(CGAL::EQUAL, true, 0.0, false, 0.0);
  for (Index j = 0; j < a.cols(); ++j) {
    for (Index i = 0; i < a.rows(); ++i) {
      program.set_a(static_cast<int>(j), static_cast<int>(i), a(i, j));
    }
    program.set_c(static_cast<int>(j), -objective[j]);
  }
  for (Index i = 0; i < b.size(); ++i) program.set_b(static_cast<int>(i), b[i]);
  // With the default choice of the entering variable some degenerate programs cycle.
  CGAL::Quadratic_program_options options;
  options.set_pricing_strategy(CGAL::QP_BLAND);
  const auto solved = CGAL::solve_nonnegative_linear_program(program, CGAL::Gmpzf(), options);
  LinearProgramSolution solution;
  if (solved.is_unbounded()) solution.outcome = LinearProgramOutcome::Unbounded;
  if (!solved.is_optimal()) return solution;
  solution.outcome = LinearProgramOutcome::Optimal;
  solution.value = -CGAL::to_double(solved.objective_value());
  if (solution.value == 0.0) {  // perhaps by underflow
    solution.value = -std::numeric_limits<double>::denorm_min() *
                     static_cast<int>(CGAL::sign(solved.objective_value()));
  }
  solution.x.resize(objective.size());
  Index j = 0;
  for (auto value = solved.variable_values_begin(); value != solved.variable_values_end();
       ++value) {
    solution.x[j++] = CGAL::to_double(*value);
  }
  return solution;
}

}  // namespace graspfit::geometry
