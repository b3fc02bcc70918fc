#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "hull/exact_hyperplane.hpp"

namespace graspfit::geometry::internal {

/// What a `ConvexPolytope` holds, which its copies share.
///
/// Points, coordinates and facets are those of the hull in its span. There points are seen in
/// `axes`, as many coordinates as the rank that tell all points of the span apart: an affine image
/// of the hull, computed without rounding.
struct PolytopeData {
  Eigen::MatrixXd points;
  int rank = -1;
  std::vector<int> vertices;
  Eigen::MatrixXi facets;
  Eigen::MatrixXi neighbors;
  Eigen::MatrixXd normals;
  Eigen::VectorXd offsets;
  double measure = 0.0;

  std::vector<int> independent;  ///< points that span the span, the first as origin
  std::vector<int> axes;
  std::array<int, kMaxDimension> exponents = {};  ///< coordinates are divided by 2^exponent
  bool has_scaled_points = true;                  ///< without rounding
  Eigen::MatrixXd directions;  ///< dimension × rank, orthonormal; the identity at full rank
  Eigen::MatrixXd gradients;  ///< rank × facets: side value = gradient · (x − corner 0), scaled
  Eigen::VectorXd unit_bounds;       ///< of the error of that value, per length of x − corner 0
  Eigen::VectorXd distance_factors;  ///< distance = −value · factor

  int dimension() const { return static_cast<int>(points.rows()); }
};

/// The hull of the columns of `points`: 2 to 6 coordinates each, all finite.
PolytopeData polytope_data(const Eigen::Ref<const Eigen::MatrixXd>& points);

/// Rows of the directions of the span that belong to the axes.
Eigen::MatrixXd directions_on_axes(const PolytopeData& data);

/// The scale of every axis.
std::array<int, kMaxDimension> scales_of(const IntegerPoints& points);

}  // namespace graspfit::geometry::internal
