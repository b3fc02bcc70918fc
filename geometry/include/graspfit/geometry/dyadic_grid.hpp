#pragma once

#include <Eigen/Core>

#include "graspfit/base/floating_point.hpp"

namespace graspfit::geometry {

/// The nearest multiples of 2^`power` to the entries of a matrix, halves to even. Sums and
/// differences of such numbers are exact as long as they stay below 2^(53 + `power`).
Eigen::MatrixXd rounded_to_grid(const Eigen::Ref<const Eigen::MatrixXd>& matrix, int power);

/// The least power of two above the absolute value of a finite number; 0 for zero.
int power_above(double value);

}  // namespace graspfit::geometry
