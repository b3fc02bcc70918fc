#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/linear_program.hpp"
#include "support/catch.hpp"

namespace test_linear_program {

using namespace graspfit::base;
using namespace graspfit::geometry;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Returns the best basic solution. An optimum, where there is one, is reached at a vertex, where
/// all but as many unknowns as there are constraints are zero. If it is empty, there is no vertex,
/// and so nothing is feasible.
std::optional<double> best_vertex(const VectorXd& objective, const MatrixXd& a, const VectorXd& b) {
  std::optional<double> best;
  std::vector<Index> chosen(static_cast<std::size_t>(a.rows()));
  const auto visit = [&](const auto& self, std::size_t depth, Index first) -> void {
    if (depth < chosen.size()) {
      for (Index j = first; j < a.cols(); ++j) {
        chosen[depth] = j;
        self(self, depth + 1, j + 1);
      }
      return;
    }
    MatrixXd basis(a.rows(), a.rows());
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      basis.col(static_cast<Index>(k)) = a.col(chosen[k]);
    }
    const Eigen::FullPivLU<MatrixXd> lu(basis);
    if (!lu.isInvertible()) return;
    const VectorXd x = lu.solve(b);
    if (x.minCoeff() < -1e-12) return;
    double value = 0.0;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      value += objective[chosen[k]] * x[static_cast<Index>(k)];
    }
    if (!best || value > *best) best = value;
  };
  visit(visit, 0, 0);
  return best;
}

}  // namespace

TEST_CASE("A linear program's optimum is that of all vertices", "[geometry][linear_program]") {
  Random random(71);
  int num_optimal = 0;
  int num_infeasible = 0;
  for (int i = 0; i < 60; ++i) {
    const Index rows = 1 + i % 4;
    const Index columns = rows + 1 + i % 5;
    MatrixXd a(rows, columns);
    for (double& x : a.reshaped()) x = random.uniform(-1.0, 1.0);
    a.row(0).setConstant(1.0);  // The unknowns sum up to 1, so that it is bounded.
    VectorXd b(rows);
    for (double& x : b) x = random.uniform(-0.3, 0.3);
    b[0] = 1.0;
    VectorXd objective(columns);
    for (double& x : objective) x = random.uniform(-1.0, 1.0);
    const LinearProgramSolution solution = maximize_linear(objective, a, b);
    const std::optional<double> expected = best_vertex(objective, a, b);
    REQUIRE((solution.outcome == LinearProgramOutcome::Optimal) == expected.has_value());
    if (!expected) {
      CHECK(solution.outcome == LinearProgramOutcome::Infeasible);
      CHECK(solution.x.size() == 0);
      ++num_infeasible;
      continue;
    }
    ++num_optimal;
    CHECK(solution.value == Approx(*expected).epsilon(1e-11).margin(1e-12));
    CHECK(solution.x.minCoeff() >= 0.0);
    CHECK((a * solution.x - b).cwiseAbs().maxCoeff() < 1e-14);
    CHECK(objective.dot(solution.x) == Approx(solution.value).epsilon(1e-12).margin(1e-14));
  }
  CHECK(num_optimal >= 20);
  CHECK(num_infeasible >= 5);
}

TEST_CASE("Signs and outcomes are exact", "[geometry][linear_program]") {
  // The constraint is x + (1 + 2^-52) y = 1, and y − x is largest where x = 0.
  MatrixXd a(1, 2);
  a << 1.0, 1.0 + 0x1p-52;
  VectorXd objective(2);
  objective << -1.0, 1.0;
  LinearProgramSolution solution = maximize_linear(objective, a, VectorXd::Ones(1));
  REQUIRE(solution.outcome == LinearProgramOutcome::Optimal);
  CHECK(solution.value == 1.0 / (1.0 + 0x1p-52));
  CHECK(solution.x == Eigen::Vector2d(0.0, 1.0 / (1.0 + 0x1p-52)));

  // Two nearly parallel constraints are infeasible by 2^-1000, and feasible when equal.
  MatrixXd twice(2, 1);
  twice << 1.0, 1.0;
  VectorXd right(2);
  right << 0.0, 0x1p-1000;
  CHECK(maximize_linear(VectorXd::Ones(1), twice, right).outcome ==
        LinearProgramOutcome::Infeasible);
  right[1] = 0.0;
  solution = maximize_linear(VectorXd::Ones(1), twice, right);
  CHECK(solution.outcome == LinearProgramOutcome::Optimal);
  CHECK(solution.value == 0.0);

  // An optimum of 1e-400, or minus that, is no double, but has a sign.
  const VectorXd tiny = VectorXd::Constant(1, 1e-200);
  CHECK(maximize_linear(tiny, MatrixXd::Ones(1, 1), tiny).value > 0.0);
  CHECK(maximize_linear(-tiny, MatrixXd::Ones(1, 1), tiny).value < 0.0);

  // The constraint x − y = 0 lets both grow.
  a << 1.0, -1.0;
  solution = maximize_linear(VectorXd::Ones(2), a, VectorXd::Zero(1));
  CHECK(solution.outcome == LinearProgramOutcome::Unbounded);
  CHECK(solution.x.size() == 0);
}

TEST_CASE("Degenerate programs come to an end", "[geometry][linear_program]") {
  // The wrenches are those of a grasp of three contacts, in 1/4096, with one left out. The
  // objective is the largest share that all of them can have in a resultant of zero. Choosing the
  // unknown of the steepest descent goes round in circles here, as all right sides but one are
  // zero.
  Eigen::Matrix<double, 23, 6> wrenches;
  wrenches << 711, 1148, 4200, 1892, -232, -257, -430, 647, 4343, 1735, 238, 136, -902, -513, 4288,
      1240, 432, 313, -430, -1653, 4067, 697, 234, 169, 711, -2106, 3811, 424, -238, -211, 1852,
      -1605, 3668, 582, -708, -604, 2325, -445, 3723, 1076, -901, -780, 1852, 695, 3943, 1619, -704,
      -636, -101, -4364, 636, 1179, -86, -405, -1259, -4224, 176, 830, -229, 432, -1739, -3942,
      -948, -14, -187, 803, -1259, -3683, -2077, -858, 16, 491, -101, -3598, -2550, -1207, 261,
      -321, 1057, -3738, -2090, -858, 405, -1157, 1537, -4021, -967, -14, 362, -1528, 1057, -4280,
      162, 830, 159, -1217, -4296, -1001, 37, -15, 141, 2144, -3992, -1480, 1155, 673, -503, 1680,
      -3653, -1001, 2262, 1389, -1143, 1738, -3477, 157, 2711, 1716, -1404, 2282, -3567, 1315, 2238,
      1461, -1133, 2994, -3872, 1794, 1120, 774, -488, 3458, -4211, 1315, 12, 57, 152, 3400;
  const Eigen::Matrix<double, 7, 23> a =
      (Eigen::Matrix<double, 7, 23>() << wrenches.transpose() / 4096.0,
       Eigen::RowVectorXd::Ones(23))
          .finished();
  MatrixXd constraints(7, 25);
  constraints << a, a.rowwise().sum(), -a.rowwise().sum();
  VectorXd objective = VectorXd::Zero(25);
  objective[23] = 1.0;
  objective[24] = -1.0;
  const LinearProgramSolution solution =
      maximize_linear(objective, constraints, VectorXd::Unit(7, 6));
  REQUIRE(solution.outcome == LinearProgramOutcome::Optimal);
  // The value is that of HiGHS, by dual simplex and interior points alike (scipy.optimize.linprog).
  CHECK(solution.value == Approx(-0.07044609300396587).epsilon(1e-12));
}

TEST_CASE("Linear programs whose parts do not fit are refused", "[geometry][linear_program]") {
  const VectorXd one = VectorXd::Ones(1);
  CHECK_THROWS_WITH(maximize_linear(VectorXd::Ones(2), MatrixXd::Ones(1, 3), one),
                    graspfit::testing::Contains("1 x 3, must be finite and 1 x 2"));
  CHECK_THROWS_AS(maximize_linear(VectorXd(0), MatrixXd(1, 0), one), InvalidInput);
  CHECK_THROWS_AS(maximize_linear(one, MatrixXd::Constant(1, 1, std::nan("")), one), InvalidInput);
  CHECK_THROWS_AS(maximize_linear(one, MatrixXd::Ones(1, 1),
                                  VectorXd::Constant(1, std::numeric_limits<double>::infinity())),
                  InvalidInput);
}

}  // namespace test_linear_program
