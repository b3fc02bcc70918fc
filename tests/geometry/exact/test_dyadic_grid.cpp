#include "graspfit/geometry/dyadic_grid.hpp"
#include "support/catch.hpp"

namespace test_dyadic_grid {

using namespace graspfit::geometry;

TEST_CASE("Numbers go to the nearest multiple of a power of two, halves to even",
          "[geometry][dyadic_grid]") {
  const Eigen::RowVector4d numbers(0.3, -1.125, 0.375, 2.0);
  const Eigen::MatrixXd rounded = rounded_to_grid(numbers, -2);
  CHECK(rounded == Eigen::RowVector4d(0.25, -1.0, 0.5, 2.0));
  CHECK(rounded_to_grid(numbers, -60) == numbers);
  CHECK(rounded_to_grid(Eigen::MatrixXd(3, 0), 4).cols() == 0);
}

TEST_CASE("Sums on a grid are exact in either order", "[geometry][dyadic_grid]") {
  const Eigen::RowVector3d numbers(0.1, 0.2, 0.3);
  const auto sums_agree = [](const Eigen::MatrixXd& x) {
    return (x(0) + x(1)) + x(2) == x(0) + (x(1) + x(2));
  };
  CHECK_FALSE(sums_agree(numbers));
  CHECK(sums_agree(rounded_to_grid(numbers, power_above(3 * numbers.maxCoeff()) - 52)));
}

TEST_CASE("The power above a number is the least", "[geometry][dyadic_grid]") {
  CHECK(power_above(0.75) == 0);
  CHECK(power_above(1.0) == 1);  // It is above, not at.
  CHECK(power_above(-5.0) == 3);
  CHECK(power_above(0.0) == 0);
}

}  // namespace test_dyadic_grid
