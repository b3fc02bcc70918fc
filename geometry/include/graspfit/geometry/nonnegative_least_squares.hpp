#pragma once

#include <Eigen/Core>

#include "graspfit/base/floating_point.hpp"

namespace graspfit::geometry {

/// A minimizer x ≥ 0 of ‖A x − b‖ by active sets [Lawson & Hanson 1974, chapter 23]: its positive
/// entries belong to independent columns. Approximate to rounding.
/// @throws InvalidInput if a number is not finite, or b is not as long as A is high.
Eigen::VectorXd nonnegative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

}  // namespace graspfit::geometry
