#include "graspfit/geometry/dyadic_grid.hpp"

#include <cmath>

namespace graspfit::geometry {

Eigen::MatrixXd rounded_to_grid(const Eigen::Ref<const Eigen::MatrixXd>& matrix, int power) {
  return matrix.unaryExpr(
      [power](double x) { return std::ldexp(std::nearbyint(std::ldexp(x, -power)), power); });
}

int power_above(double value) {
  int power = 0;
  std::frexp(value, &power);
  return power;
}

}  // namespace graspfit::geometry
