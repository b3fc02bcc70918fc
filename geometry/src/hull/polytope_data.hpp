#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "hull/exact_hyperplane.hpp"

namespace graspfit::geometry::internal {

/// What a `ConvexPolytope` holds, which its copies share.
///
/// The hull is that in the affine span of the points. Points of the span are given by their
/// coordinates on `axes`, as many axes as the rank, which tell all points of the span apart: this
/// projection is an affine image of the hull, computed without rounding.
struct PolytopeData {
  Eigen::MatrixXd points;
  int rank = -1;
  std::vector<int> vertices;
  Eigen::MatrixXi facets;
  Eigen::MatrixXi neighbors;
  Eigen::MatrixXd normals;
  Eigen::VectorXd offsets;
  double measure = 0.0;

  std::vector<int> independent;  ///< affinely independent points of the span, the first as origin
  std::vector<int> axes;
  std::array<int, kMaxDimension> exponents = {};  ///< coordinates are divided by 2^exponent
  bool has_scaled_points = true;                  ///< whether that division is exact
  Eigen::MatrixXd directions;  ///< dimension × rank, orthonormal; the identity at full rank
  Eigen::MatrixXd gradients;  ///< rank × facets: side value = gradient · (x − corner 0), scaled
  Eigen::VectorXd unit_bounds;       ///< of the error of that value, per length of x − corner 0
  Eigen::VectorXd distance_factors;  ///< distance = −value · factor

  int dimension() const { return static_cast<int>(points.rows()); }
};

/// The hull of the columns of `points`: 2 to 6 coordinates each, all finite.
PolytopeData polytope_data(const Eigen::Ref<const Eigen::MatrixXd>& points);

/// The rows of `directions` that belong to `axes`.
Eigen::MatrixXd directions_on_axes(const PolytopeData& data);

/// The scale of every axis.
std::array<int, kMaxDimension> scales_of(const IntegerPoints& points);

}  // namespace graspfit::geometry::internal
