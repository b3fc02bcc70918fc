#include "graspfit/geometry/convex_polytope.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "graspfit/base/as_index.hpp"
#include "graspfit/base/errors.hpp"
#include "hull/hull_builder.hpp"
#include "hull/polytope_data.hpp"

namespace graspfit::geometry {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using internal::IntegerEchelon;
using internal::IntegerHyperplane;
using internal::IntegerPoints;
using internal::kMaxDimension;
using internal::PolytopeData;

namespace {

void require_finite(const Eigen::Ref<const VectorXd>& point, int dimension, const char* where) {
  if (point.size() != dimension || !point.allFinite()) {
    throw base::InvalidInput(std::string("ConvexPolytope::") + where + ": the point must have " +
                             std::to_string(dimension) + " finite coordinates");
  }
}

/// A side value that the filter may or may not decide.
struct SideValue {
  double value;
  double bound;  // of its error
  bool is_certain() const { return std::abs(value) > bound; }
};

/// A query point on the scaled axes.
class ScaledPoint {
 public:
  ScaledPoint(const PolytopeData& data, const Eigen::Ref<const VectorXd>& point)
      : data_(data),
        rank_(base::as_index<int>(data.axes.size())),
        is_exact_(data.has_scaled_points) {
    for (int j = 0; j < rank_; ++j) {
      const double x = point[data.axes[j]];
      coordinates_[j] = std::ldexp(x, -data.exponents[j]);
      is_exact_ = is_exact_ && std::ldexp(coordinates_[j], data.exponents[j]) == x &&
                  (x == 0.0 || std::isnormal(coordinates_[j]));
    }
  }

  SideValue side(Index facet) const {
    double value = 0.0;
    double squared_length = 0.0;
    for (int j = 0; j < rank_; ++j) {
      const double difference =
          coordinates_[j] -
          std::ldexp(data_.points(data_.axes[j], data_.facets(0, facet)), -data_.exponents[j]);
      value += data_.gradients(j, facet) * difference;
      squared_length += difference * difference;
    }
    if (!is_exact_ || squared_length < internal::kLeastSquaredProduct) {
      return {value, std::numeric_limits<double>::infinity()};
    }
    // Of the 64 units that the bound allows 27 are needed: 19 of the gradient, 1 of the difference,
    // 1 of the product and 6 of the sum.
    const double bound = data_.unit_bounds[facet] * std::sqrt(squared_length);
    return {value, bound + internal::kUnderflowSlack};
  }

 private:
  const PolytopeData& data_;
  int rank_;
  bool is_exact_;
  std::array<double, kMaxDimension> coordinates_ = {};
};

struct ExactSide {
  int sign = 0;           // positive outside
  double distance = 0.0;  // from the facet's plane, negative outside. Rounded
};

/// The side of a facet on which a point of the span lies, by integers.
ExactSide exact_side(const PolytopeData& data, Index facet,
                     const Eigen::Ref<const VectorXd>& point) {
  const auto rank = std::ssize(data.axes);
  MatrixXd corners_and_point(rank, rank + 1);
  corners_and_point << data.points(data.axes, data.facets.col(facet)), point(data.axes);
  std::array<int, kMaxDimension> corners;
  std::iota(corners.begin(), corners.end(), 0);
  IntegerPoints exact(corners_and_point);
  IntegerHyperplane plane;
  exact.hyperplane({corners.data(), static_cast<std::size_t>(rank)}, plane);
  const internal::BinaryParts value = exact.evaluate(plane, static_cast<int>(rank));
  std::array<long, kMaxDimension> exponents;
  long largest = std::numeric_limits<long>::min();
  VectorXd gradient(rank);
  for (Index j = 0; j < rank; ++j) {
    const auto [mantissa, exponent] = plane.normal_parts[j];
    gradient[j] = mantissa;
    exponents[j] = exponent + exact.scale(static_cast<int>(j));
    if (mantissa != 0.0) largest = std::max(largest, exponents[j]);
  }
  for (Index j = 0; j < rank; ++j) {
    const long shift = exponents[j] - largest;
    gradient[j] = std::ldexp(gradient[j], static_cast<int>(std::max(shift, -2000L)));
  }
  const auto [mantissa, exponent] = value;
  const double scaled =
      std::ldexp(mantissa, static_cast<int>(std::clamp(exponent - largest, -2000L, 2000L)));
  ExactSide side;
  // At rank 1 a facet has a single corner, whose order cannot tell which side is outside.
  const int orientation = rank == 1 && data.gradients(0, facet) < 0.0 ? -1 : 1;
  side.sign = orientation * ((mantissa > 0.0) - (mantissa < 0.0));
  side.distance =
      -orientation * scaled / (internal::directions_on_axes(data).transpose() * gradient).norm();
  if (side.sign != 0 && side.distance == 0.0) {  // a distance too small for a double is not zero
    side.distance = -side.sign * std::numeric_limits<double>::min();
  }
  return side;
}

/// Whether a point lies in the span of a hull of lower rank.
bool is_in_span(const PolytopeData& data, const Eigen::Ref<const VectorXd>& point) {
  const auto count = base::as_index<int>(data.independent.size());
  MatrixXd spanning(data.dimension(), count + 1);
  spanning << data.points(Eigen::seqN(0, data.dimension()), data.independent), point;
  const IntegerPoints exact(spanning);
  IntegerEchelon echelon(exact.dimension(), internal::scales_of(exact));
  for (int k = 1; k < count; ++k) echelon.add(exact.point(k));
  return !echelon.add(exact.point(count));
}

/// Distance from the nearest facet of a point of the span, negative outside; see `inradius`.
double distance_within_span(const PolytopeData& data, const Eigen::Ref<const VectorXd>& point) {
  const ScaledPoint scaled(data, point);
  const Index count = data.facets.cols();
  std::vector<std::pair<double, double>> ranges;  // lowest and highest possible distance
  double nearest = std::numeric_limits<double>::infinity();
  for (Index f = 0; f < count; ++f) {
    const SideValue side = scaled.side(f);
    ranges.emplace_back(-(side.value + side.bound) * data.distance_factors[f],
                        -(side.value - side.bound) * data.distance_factors[f]);
    nearest = std::min(nearest, ranges.back().second);
  }
  double distance = std::numeric_limits<double>::infinity();
  for (Index f = 0; f < count; ++f) {
    const auto [low, high] = ranges[f];
    if (low > nearest) continue;
    const double middle = 0.5 * (low + high);
    const bool is_precise = high - low <= internal::kNormalPrecision * std::abs(middle);
    distance = std::min(distance, is_precise ? middle : exact_side(data, f, point).distance);
  }
  return distance;
}

}  // namespace

ConvexPolytope::ConvexPolytope(const Eigen::Ref<const MatrixXd>& points) {
  if (points.rows() < 2 || points.rows() > kMaxDimension) {
    throw base::InvalidInput("ConvexPolytope: points have " + std::to_string(points.rows()) +
                             " coordinates, must be 2 to 6");
  }
  for (Index i = 0; i < points.cols(); ++i) {
    if (!points.col(i).allFinite()) {
      throw base::InvalidInput("ConvexPolytope: point " + std::to_string(i) + " is not finite");
    }
  }
  data_ = std::make_shared<const PolytopeData>(internal::polytope_data(points));
}

int ConvexPolytope::dimension() const { return data_->dimension(); }
int ConvexPolytope::rank() const { return data_->rank; }
const MatrixXd& ConvexPolytope::points() const { return data_->points; }
const std::vector<int>& ConvexPolytope::vertices() const { return data_->vertices; }
const Eigen::MatrixXi& ConvexPolytope::facets() const { return data_->facets; }
const Eigen::MatrixXi& ConvexPolytope::neighbors() const { return data_->neighbors; }
const MatrixXd& ConvexPolytope::normals() const { return data_->normals; }
const VectorXd& ConvexPolytope::offsets() const { return data_->offsets; }
double ConvexPolytope::measure() const { return data_->measure; }
double ConvexPolytope::volume() const { return rank() == dimension() ? measure() : 0.0; }

Containment ConvexPolytope::containment(const Eigen::Ref<const VectorXd>& point) const {
  require_finite(point, dimension(), "containment");
  if (rank() < 0) return Containment::Outside;
  if (rank() < dimension() && !is_in_span(*data_, point)) return Containment::Outside;
  const ScaledPoint scaled(*data_, point);
  std::vector<Index> uncertain;
  for (Index f = 0; f < data_->facets.cols(); ++f) {
    const SideValue side = scaled.side(f);
    if (!side.is_certain()) {
      uncertain.push_back(f);
    } else if (side.value > 0.0) {
      return Containment::Outside;
    }
  }
  bool is_on_surface = rank() < dimension();
  for (const Index f : uncertain) {
    const int sign = exact_side(*data_, f, point).sign;
    if (sign > 0) return Containment::Outside;
    is_on_surface = is_on_surface || sign == 0;
  }
  return is_on_surface ? Containment::OnSurface : Containment::Inside;
}

double ConvexPolytope::inradius(const Eigen::Ref<const VectorXd>& point) const {
  require_finite(point, dimension(), "inradius");
  if (rank() < 0) return -std::numeric_limits<double>::infinity();
  if (rank() == 0) return -(point - data_->points.col(data_->vertices[0])).stableNorm();
  const double within = distance_within_span(*data_, point);
  if (rank() == dimension()) return within;
  if (is_in_span(*data_, point)) return std::min(within, 0.0);
  const VectorXd difference = point - data_->points.col(data_->independent[0]);
  const VectorXd along = data_->directions.transpose() * difference;
  const double from_span = (difference - data_->directions * along).stableNorm();
  return std::min(-std::max(from_span, std::numeric_limits<double>::min()), within);
}

}  // namespace graspfit::geometry
