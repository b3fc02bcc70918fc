#include "graspfit/geometry/minkowski_sum.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/geometry/dyadic_grid.hpp"

namespace graspfit::geometry {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Most points that are added per round. The points of the sum farthest beyond the facets nearest
/// to the origin are added together, since a hull is built for each round.
constexpr int kPointsPerRound = 12;

/// Checked copies of the summands, rounded to a grid on which sums of one column of each are exact.
std::vector<MatrixXd> on_common_grid(std::span<const MatrixXd> summands, const char* where) {
  if (summands.empty()) throw base::InvalidInput(std::string(where) + ": there are no summands");
  double largest = 0.0;
  for (const MatrixXd& summand : summands) {
    const Index rows = summand.rows();
    if (rows < 2 || rows > 6 || rows != summands.front().rows() || summand.cols() == 0 ||
        !summand.allFinite()) {
      throw base::InvalidInput(
          std::string(where) +
          ": summands must have the same 2 to 6 rows, a column or more, and be "
          "finite; one is " +
          std::to_string(rows) + " x " + std::to_string(summand.cols()));
    }
    largest = std::max(largest, summand.cwiseAbs().maxCoeff());
  }
  const int power = power_above(largest * static_cast<double>(summands.size())) - 53;
  std::vector<MatrixXd> rounded;
  for (const MatrixXd& summand : summands) rounded.push_back(rounded_to_grid(summand, power));
  return rounded;
}

/// A point of the sum that is farthest in a direction, and how far it is.
struct Support {
  VectorXd point;
  double value = 0.0;
};

/// The support of a sum of summands, each with the origin added to its points.
Support support(const std::vector<MatrixXd>& summands, const VectorXd& direction) {
  Support result{VectorXd::Zero(direction.size()), 0.0};
  for (const MatrixXd& summand : summands) {
    Index best = 0;
    const double value = (direction.transpose() * summand).maxCoeff(&best);
    if (value <= 0.0) continue;
    result.point += summand.col(best);
    result.value += value;
  }
  return result;
}

/// Points of the sum, no two equal, as columns.
class PointsOfSum {
 public:
  explicit PointsOfSum(Index dimension) : points_(dimension, 0) {}

  bool add(const VectorXd& point) {
    for (Index i = 0; i < points_.cols(); ++i) {
      if (points_.col(i) == point) return false;
    }
    points_.conservativeResize(Eigen::NoChange, points_.cols() + 1);
    points_.rightCols(1) = point;
    return true;
  }

  const MatrixXd& columns() const { return points_; }
  int size() const { return static_cast<int>(points_.cols()); }

 private:
  MatrixXd points_;
};

}  // namespace

void MinkowskiInradiusOptions::validate() const {
  base::require(relative_gap >= 0.0 && std::isfinite(relative_gap), "MinkowskiInradiusOptions",
                "relative_gap", relative_gap, "finite and at least 0");
  base::require(max_points >= 1, "MinkowskiInradiusOptions", "max_points", max_points,
                "at least 1");
}

ConvexPolytope minkowski_sum(std::span<const MatrixXd> summands) {
  const std::vector<MatrixXd> rounded = on_common_grid(summands, "minkowski_sum");
  ConvexPolytope sum(rounded.front());
  for (std::size_t k = 1; k < rounded.size(); ++k) {
    const MatrixXd& summand = rounded[k];
    MatrixXd points(summand.rows(), sum.vertices().size() * summand.cols());
    Index column = 0;
    for (const int vertex : sum.vertices()) {
      for (Index i = 0; i < summand.cols(); ++i) {
        points.col(column++) = sum.points().col(vertex) + summand.col(i);
      }
    }
    sum = ConvexPolytope(points);
  }
  return sum;
}

InradiusBounds minkowski_sum_inradius(std::span<const MatrixXd> summands,
                                      const MinkowskiInradiusOptions& options) {
  options.validate();
  const std::vector<MatrixXd> rounded = on_common_grid(summands, "minkowski_sum_inradius");
  const Index dimension = rounded.front().rows();

  // The origin is within the sum exactly if it is within the hull of all columns: in both cases
  // every direction has a positive dot product with some column.
  Index num_columns = 0;
  for (const MatrixXd& summand : rounded) num_columns += summand.cols();
  MatrixXd all(dimension, num_columns);
  Index column = 0;
  for (const MatrixXd& summand : rounded) {
    all.middleCols(column, summand.cols()) = summand;
    column += summand.cols();
  }
  InradiusBounds bounds;
  const VectorXd origin = VectorXd::Zero(dimension);
  if (ConvexPolytope(all).containment(origin) != Containment::Inside) return bounds;

  PointsOfSum points(dimension);
  bounds.upper = std::numeric_limits<double>::infinity();
  const auto add_support = [&](const VectorXd& direction) {
    const Support farthest = support(rounded, direction);
    if (farthest.value < bounds.upper) {
      bounds.upper = farthest.value;
      bounds.direction = direction;
    }
    return points.add(farthest.point);
  };
  for (Index j = 0; j < dimension; ++j) {
    add_support(VectorXd::Unit(dimension, j));
    add_support(-VectorXd::Unit(dimension, j));
  }
  for (;;) {
    const ConvexPolytope hull(points.columns());
    bounds.lower = std::max(0.0, hull.inradius(origin));
    bounds.num_points = points.size();
    if (bounds.lower >= bounds.upper * (1.0 - options.relative_gap) ||
        points.size() >= options.max_points) {
      break;
    }
    bool has_grown = false;
    if (hull.rank() < dimension) {
      // The hull lacks a dimension: it grows out of its span, in both directions.
      const MatrixXd centered = points.columns().colwise() - points.columns().col(0);
      const MatrixXd basis = Eigen::FullPivHouseholderQR<MatrixXd>(centered).matrixQ();
      has_grown = add_support(basis.rightCols(1));
      has_grown = add_support(-basis.rightCols(1)) || has_grown;
    } else {
      std::vector<Index> nearest(hull.num_facets());
      std::iota(nearest.begin(), nearest.end(), Index{0});
      std::sort(nearest.begin(), nearest.end(), [&](Index a, Index b) {
        return hull.offsets()[a] != hull.offsets()[b] ? hull.offsets()[a] < hull.offsets()[b]
                                                      : a < b;
      });
      int added = 0;
      for (const Index facet : nearest) {
        if (added == kPointsPerRound || hull.offsets()[facet] >= bounds.upper) break;
        if (add_support(hull.normals().col(facet))) ++added;
      }
      has_grown = added > 0;
    }
    if (!has_grown) break;  // the bounds differ by rounding
  }
  return bounds;
}

}  // namespace graspfit::geometry
