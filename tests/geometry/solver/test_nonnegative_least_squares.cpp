#include <cmath>
#include <limits>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/nonnegative_least_squares.hpp"
#include "support/catch.hpp"

namespace test_nonnegative_least_squares {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using graspfit::base::InvalidInput;
using graspfit::base::Random;
using graspfit::geometry::nonnegative_least_squares;

TEST_CASE("A minimizer meets the conditions of Karush, Kuhn and Tucker",
          "[geometry][nonnegative_least_squares]") {
  // They are sufficient here, since the objective is convex.
  Random random(7);
  for (int round = 0; round < 500; ++round) {
    const Index rows = 1 + static_cast<Index>(random.index(8));
    const Index columns = 1 + static_cast<Index>(random.index(12));
    MatrixXd a(rows, columns);
    VectorXd b(rows);
    for (double& number : a.reshaped()) number = 2.0 * random.uniform() - 1.0;
    for (double& number : b) number = 2.0 * random.uniform() - 1.0;
    if (columns > 2) a.col(1) = 3.0 * a.col(0);  // Columns may depend on one another.
    const VectorXd x = nonnegative_least_squares(a, b);
    const VectorXd gradient = a.transpose() * (a * x - b);
    INFO("round " << round);
    CHECK(x.minCoeff() >= 0.0);
    CHECK(gradient.minCoeff() >= -1e-11);
    CHECK(gradient.cwiseAbs().cwiseProduct(x).maxCoeff() <= 1e-11 * (1.0 + x.maxCoeff()));
  }
}

TEST_CASE("The nearest point of a quadrant", "[geometry][nonnegative_least_squares]") {
  const MatrixXd axes = MatrixXd::Identity(2, 2);
  CHECK(nonnegative_least_squares(axes, Eigen::Vector2d(3, 4)) == Eigen::Vector2d(3, 4));
  CHECK(nonnegative_least_squares(axes, Eigen::Vector2d(3, -4)) == Eigen::Vector2d(3, 0));
  CHECK(nonnegative_least_squares(axes, Eigen::Vector2d(-3, -4)) == Eigen::Vector2d(0, 0));
}

TEST_CASE("What is no least squares problem is refused", "[geometry][nonnegative_least_squares]") {
  const MatrixXd axes = MatrixXd::Identity(2, 2);
  CHECK_THROWS_AS(nonnegative_least_squares(axes, Eigen::Vector3d(1, 2, 3)), InvalidInput);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    CHECK_THROWS_AS(nonnegative_least_squares(axes, Eigen::Vector2d(1, bad)), InvalidInput);
    CHECK_THROWS_AS(nonnegative_least_squares(bad * axes, Eigen::Vector2d(1, 2)), InvalidInput);
  }
}

}  // namespace test_nonnegative_least_squares
