#include "graspfit/geometry/convex_polytope.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "hull/exact_hyperplane.hpp"
#include "hull/hull_builder.hpp"

namespace graspfit::geometry {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using internal::IntegerEchelon;
using internal::IntegerHyperplane;
using internal::IntegerPoints;
using internal::kMaxDimension;

/// Points, coordinates and facets of the hull in its span. There points are seen in `axes`, as
/// many coordinates as the rank that tell all points of the span apart: an affine image of the
/// hull, computed without rounding.
struct ConvexPolytope::Impl {
  MatrixXd points;
  int rank = -1;
  std::vector<int> vertices;
  Eigen::MatrixXi facets;
  Eigen::MatrixXi neighbors;
  MatrixXd normals;
  VectorXd offsets;
  double measure = 0.0;

  std::vector<int> independent;  // points that span the span, the first as origin
  std::vector<int> axes;
  std::array<int, kMaxDimension> exponents = {};  // coordinates are divided by 2^exponent
  bool has_scaled_points = true;                  // without rounding
  MatrixXd directions;   // dimension × rank, orthonormal; the identity at full rank
  MatrixXd gradients;    // rank × facets: side value = gradient · (x − corner 0) in scaled axes
  VectorXd unit_bounds;  // of the error of that value, per length of x − corner 0
  VectorXd stretches;    // distance = −value · stretch

  int dimension() const { return static_cast<int>(points.rows()); }
};

namespace {

using Impl = ConvexPolytope::Impl;

void require_finite(const Eigen::Ref<const VectorXd>& point, int dimension, const char* where) {
  if (point.size() != dimension || !point.allFinite()) {
    throw base::InvalidInput(std::string("ConvexPolytope::") + where + ": the point must have " +
                             std::to_string(dimension) + " finite coordinates");
  }
}

/// Indices of distinct points in lexicographic order, of equal ones the lowest.
std::vector<int> distinct_points(const MatrixXd& points) {
  std::vector<int> order(static_cast<std::size_t>(points.cols()));
  std::iota(order.begin(), order.end(), 0);
  const auto compare = [&](int a, int b) {
    for (Index j = 0; j < points.rows(); ++j) {
      if (points(j, a) != points(j, b)) return points(j, a) < points(j, b) ? -1 : 1;
    }
    return 0;
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const int sign = compare(a, b);
    return sign != 0 ? sign < 0 : a < b;
  });
  order.erase(
      std::unique(order.begin(), order.end(), [&](int a, int b) { return compare(a, b) == 0; }),
      order.end());
  return order;
}

/// Divides each row by a power of two so that its range is about one. False if that rounds
/// (numbers near the end of what a double can hold).
bool scale_rows(MatrixXd& points, std::array<int, kMaxDimension>& exponents) {
  bool is_exact = true;
  for (Index j = 0; j < points.rows(); ++j) {
    const double half_range = 0.5 * points.row(j).maxCoeff() - 0.5 * points.row(j).minCoeff();
    std::frexp(half_range > 0.0 ? half_range : points.row(j).cwiseAbs().maxCoeff(), &exponents[j]);
    for (Index i = 0; i < points.cols(); ++i) {
      const double scaled = std::ldexp(points(j, i), -exponents[j]);
      is_exact = is_exact && std::ldexp(scaled, exponents[j]) == points(j, i) &&
                 (scaled == 0.0 || std::isnormal(scaled));
      points(j, i) = scaled;
    }
  }
  return is_exact;
}

MatrixXd selected(const MatrixXd& points, const std::vector<int>& rows,
                  const std::vector<int>& columns) {
  MatrixXd result(rows.size(), columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    for (std::size_t j = 0; j < rows.size(); ++j) {
      result(static_cast<Index>(j), static_cast<Index>(i)) = points(rows[j], columns[i]);
    }
  }
  return result;
}

std::array<int, kMaxDimension> scales_of(const IntegerPoints& points) {
  std::array<int, kMaxDimension> scales = {};
  for (int j = 0; j < points.dimension(); ++j) scales[j] = points.scale(j);
  return scales;
}

/// Whether the normals of some facets span all of the space, by doubles with room to spare:
/// their determinant, the product of what each adds to the span of those before, is far above
/// what errors of 2^-36 in unit vectors can make of zero.
template <int D>
bool certainly_span(std::vector<Eigen::Matrix<double, D, 1>> normals) {
  double determinant = 1.0;
  for (int k = 0; k < D; ++k) {
    const auto largest = std::max_element(normals.begin(), normals.end(), [](auto& a, auto& b) {
      return a.squaredNorm() < b.squaredNorm();
    });
    const double length = largest->norm();
    determinant *= length;
    if (!(determinant > 0x1p-20)) return false;
    const Eigen::Matrix<double, D, 1> direction = *largest / length;
    for (auto& normal : normals) normal -= direction.dot(normal) * direction;
  }
  return true;
}

/// The hull of distinct points `chosen` that span `Impl::axes`; see `build_in_span`.
template <int D>
class SpanHull {
 public:
  SpanHull(const MatrixXd& points, const std::vector<int>& axes, const std::vector<int>& chosen)
      : coordinates_(selected(points, axes, chosen)),
        scaled_(coordinates_),
        exact_(coordinates_),
        is_exactly_scaled_(scale_rows(scaled_, exponents_)),
        builder_(scaled_, exponents_, exact_, is_exactly_scaled_) {}

  /// With `simplex` empty a spread one is tried; false if that is degenerate.
  bool build(std::vector<int> simplex) {
    if (simplex.empty()) simplex = builder_.spread_simplex();
    if (simplex.size() != D + 1 || !builder_.build(simplex)) return false;
    simplex_ = simplex;
    facets_ = builder_.facets();
    return true;
  }

  /// Corners of facets that are no extreme points: they lie within larger facets.
  std::vector<int> extreme_corners() {
    std::vector<std::vector<int>> stars(static_cast<std::size_t>(coordinates_.cols()));
    for (const int f : facets_) {
      for (const int corner : builder_.simplex(f).corners) stars[corner].push_back(f);
    }
    std::vector<int> extreme;
    for (std::size_t corner = 0; corner < stars.size(); ++corner) {
      if (!stars[corner].empty() && is_extreme(stars[corner])) {
        extreme.push_back(static_cast<int>(corner));
      }
    }
    return extreme;
  }

  int num_corners() const {
    std::vector<bool> used(static_cast<std::size_t>(coordinates_.cols()), false);
    for (const int f : facets_) {
      for (const int corner : builder_.simplex(f).corners) used[corner] = true;
    }
    return static_cast<int>(std::count(used.begin(), used.end(), true));
  }

  /// Facets in their final order, with point indices looked up in `chosen`.
  void store(const std::vector<int>& chosen, Impl& impl) {
    struct Sorted {
      std::array<int, D> corners;
      std::array<int, D> slots;
      int facet;
    };
    std::vector<Sorted> sorted;
    for (const int f : facets_) {
      Sorted s;
      s.facet = f;
      std::iota(s.slots.begin(), s.slots.end(), 0);
      const auto& corners = builder_.simplex(f).corners;
      std::sort(s.slots.begin(), s.slots.end(),
                [&](int a, int b) { return chosen[corners[a]] < chosen[corners[b]]; });
      int inversions = 0;
      for (int a = 0; a < D; ++a) {
        for (int b = a + 1; b < D; ++b) inversions += s.slots[a] > s.slots[b];
      }
      if (inversions % 2 != 0) std::swap(s.slots[D - 2], s.slots[D - 1]);
      for (int k = 0; k < D; ++k) s.corners[k] = chosen[corners[s.slots[k]]];
      sorted.push_back(s);
    }
    std::sort(sorted.begin(), sorted.end(),
              [](const Sorted& a, const Sorted& b) { return a.corners < b.corners; });
    std::vector<int> place(static_cast<std::size_t>(builder_.num_created()), -1);
    for (std::size_t i = 0; i < sorted.size(); ++i) place[sorted[i].facet] = static_cast<int>(i);

    const auto count = static_cast<Index>(sorted.size());
    impl.facets.resize(D, count);
    impl.neighbors.resize(D, count);
    impl.gradients.resize(D, count);
    impl.unit_bounds.resize(count);
    for (Index i = 0; i < count; ++i) {
      const Sorted& s = sorted[static_cast<std::size_t>(i)];
      const auto& plane = builder_.precise_plane(s.facet);
      for (int k = 0; k < D; ++k) {
        impl.facets(k, i) = s.corners[k];
        impl.neighbors(k, i) = place[builder_.simplex(s.facet).neighbors[s.slots[k]]];
        impl.gradients(k, i) = plane.normal[k];
      }
      impl.unit_bounds[i] = builder_.unit_bound(s.facet);
    }
    impl.exponents = exponents_;
    impl.has_scaled_points = is_exactly_scaled_;
    impl.independent.clear();
    for (const int i : simplex_) impl.independent.push_back(chosen[i]);
    double factor = 1.0;  // of the volume: 1 / D! and the scale of each axis
    for (int j = 0; j < D; ++j) factor *= std::ldexp(1.0 / (j + 1), exponents_[j]);
    impl.measure = factor * builder_.scaled_volume(facets_);
  }

 private:
  /// A corner is extreme if the planes of the facets around it meet nowhere else.
  bool is_extreme(const std::vector<int>& star) {
    using Normal = Eigen::Matrix<double, D, 1>;
    // A few facets from all over the star nearly always suffice.
    for (const std::size_t stride : {1 + star.size() / 24, std::size_t{1}}) {
      std::vector<Normal> normals;
      for (std::size_t k = 0; k < star.size(); k += stride) {
        normals.push_back(
            Eigen::Map<const Normal>(builder_.precise_plane(star[k]).normal.data()).normalized());
      }
      if (certainly_span<D>(std::move(normals))) return true;
    }
    IntegerEchelon echelon(D, scales_of(exact_));
    return std::any_of(star.begin(), star.end(), [&](int f) {
      echelon.add(builder_.exact_normal(f));
      return echelon.rank() == D;
    });
  }

  MatrixXd coordinates_;
  MatrixXd scaled_;
  std::array<int, kMaxDimension> exponents_ = {};
  IntegerPoints exact_;
  bool is_exactly_scaled_;
  internal::HullBuilder<D> builder_;
  std::vector<int> simplex_;
  std::vector<int> facets_;
};

/// The affine span of points, exactly: as many of them as span it, and coordinates that tell its
/// points apart.
struct Span {
  std::vector<int> independent;  // indices into `chosen`, the first as origin
  std::vector<int> axes;         // ascending
};

Span span_of(const MatrixXd& points, const std::vector<int>& axes, const std::vector<int>& chosen) {
  const IntegerPoints exact(selected(points, axes, chosen));
  IntegerEchelon echelon(exact.dimension(), scales_of(exact));
  Span span;
  span.independent.push_back(0);
  for (int i = 1; i < exact.size() && echelon.rank() < exact.dimension(); ++i) {
    if (echelon.add(exact.point(i))) span.independent.push_back(i);
  }
  for (const int column : echelon.columns()) span.axes.push_back(axes[column]);
  std::sort(span.axes.begin(), span.axes.end());
  return span;
}

/// The hull in `Impl::axes`; null if the points span less than these.
template <int D>
std::unique_ptr<SpanHull<D>> built_hull(const Impl& impl, const std::vector<int>& chosen) {
  if (chosen.size() <= D) return nullptr;
  auto hull = std::make_unique<SpanHull<D>>(impl.points, impl.axes, chosen);
  if (hull->build({})) return hull;
  const Span span = span_of(impl.points, impl.axes, chosen);
  if (span.axes.size() < D) return nullptr;
  hull = std::make_unique<SpanHull<D>>(impl.points, impl.axes, chosen);
  return hull->build(span.independent) ? std::move(hull) : nullptr;
}

/// Facets and vertices; false if the points span less than `Impl::axes`.
template <int D>
bool build_facets(std::vector<int> chosen, Impl& impl) {
  std::unique_ptr<SpanHull<D>> hull = built_hull<D>(impl, chosen);
  if (!hull) return false;
  std::vector<int> extreme = hull->extreme_corners();
  const bool is_tight = static_cast<int>(extreme.size()) == hull->num_corners();
  for (int& i : extreme) i = chosen[i];
  if (!is_tight) {
    chosen = extreme;
    hull = built_hull<D>(impl, chosen);
  }
  hull->store(chosen, impl);
  impl.vertices = std::move(extreme);
  std::sort(impl.vertices.begin(), impl.vertices.end());
  return true;
}

/// A segment's facets are its ends, the first and the last point in the order of one axis.
void build_segment(const std::vector<int>& chosen, Impl& impl) {
  const MatrixXd coordinates = selected(impl.points, impl.axes, chosen);
  Index low = 0;
  Index high = 0;
  coordinates.row(0).minCoeff(&low);
  coordinates.row(0).maxCoeff(&high);
  impl.independent = {chosen[low], chosen[high]};
  const bool is_rising = chosen[low] < chosen[high];
  impl.vertices = impl.independent;
  std::sort(impl.vertices.begin(), impl.vertices.end());
  impl.facets.resize(1, 2);
  impl.facets << impl.vertices[0], impl.vertices[1];
  impl.neighbors.resize(1, 2);
  impl.neighbors << 1, 0;
  impl.gradients.resize(1, 2);
  impl.gradients << (is_rising ? -1.0 : 1.0), (is_rising ? 1.0 : -1.0);
  impl.unit_bounds = VectorXd::Constant(2, internal::kSideUnits * 0x1p-53);
  impl.measure = coordinates(0, high) - coordinates(0, low);
}

bool build_in_axes(const std::vector<int>& chosen, Impl& impl) {
  switch (impl.axes.size()) {
    case 1:
      build_segment(chosen, impl);
      return true;
    case 2:
      return build_facets<2>(chosen, impl);
    case 3:
      return build_facets<3>(chosen, impl);
    case 4:
      return build_facets<4>(chosen, impl);
    case 5:
      return build_facets<5>(chosen, impl);
    case 6:
      return build_facets<6>(chosen, impl);
    default:
      return false;
  }
}

/// Rows of the directions of the span that belong to the axes.
MatrixXd directions_on_axes(const Impl& impl) {
  MatrixXd rows(impl.axes.size(), impl.axes.size());
  for (std::size_t j = 0; j < impl.axes.size(); ++j) {
    rows.row(static_cast<Index>(j)) = impl.directions.row(impl.axes[j]);
  }
  return rows;
}

/// What is measured in the space rather than on its axes: normals, distances, the volume of the
/// span.
void measure_in_space(Impl& impl) {
  const auto rank = static_cast<Index>(impl.axes.size());
  const bool is_full = rank == impl.dimension();
  if (is_full) {
    impl.directions = MatrixXd::Identity(rank, rank);
  } else {
    MatrixXd edges(impl.dimension(), rank);
    for (Index k = 0; k < rank; ++k) {
      edges.col(k) = (impl.points.col(impl.independent[static_cast<std::size_t>(k + 1)]) -
                      impl.points.col(impl.independent[0]))
                         .stableNormalized();
    }
    impl.directions = Eigen::HouseholderQR<MatrixXd>(edges).householderQ() *
                      MatrixXd::Identity(edges.rows(), rank);
  }
  const MatrixXd on_axes = directions_on_axes(impl);
  impl.measure /= std::abs(on_axes.determinant());
  impl.normals.resize(impl.dimension(), impl.facets.cols());
  impl.offsets.resize(impl.facets.cols());
  impl.stretches.resize(impl.facets.cols());
  VectorXd gradient(rank);
  for (Index f = 0; f < impl.facets.cols(); ++f) {
    gradient = impl.gradients.col(f);
    for (Index j = 0; j < rank; ++j) {
      gradient[j] = std::ldexp(gradient[j], -impl.exponents[static_cast<std::size_t>(j)]);
    }
    if (is_full) {
      gradient.array() += 0.0;  // no negative zeros, which the products leave none of either
    } else {
      gradient = on_axes.transpose() * gradient;
    }
    const double length = gradient.stableNorm();
    impl.stretches[f] = 1.0 / length;
    gradient /= length;
    if (is_full) {
      impl.normals.col(f) = gradient;
    } else {
      impl.normals.col(f) = impl.directions * gradient;
    }
    impl.offsets[f] = impl.normals.col(f).dot(impl.points.col(impl.facets(0, f)));
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
  ScaledPoint(const Impl& impl, const Eigen::Ref<const VectorXd>& point)
      : impl_(impl), rank_(static_cast<int>(impl.axes.size())), is_exact_(impl.has_scaled_points) {
    for (int j = 0; j < rank_; ++j) {
      const double x = point[impl.axes[j]];
      coordinates_[j] = std::ldexp(x, -impl.exponents[j]);
      is_exact_ = is_exact_ && std::ldexp(coordinates_[j], impl.exponents[j]) == x &&
                  (x == 0.0 || std::isnormal(coordinates_[j]));
    }
  }

  SideValue side(Index facet) const {
    double value = 0.0;
    double squared_length = 0.0;
    for (int j = 0; j < rank_; ++j) {
      const double difference =
          coordinates_[j] -
          std::ldexp(impl_.points(impl_.axes[j], impl_.facets(0, facet)), -impl_.exponents[j]);
      value += impl_.gradients(j, facet) * difference;
      squared_length += difference * difference;
    }
    const double bound = impl_.unit_bounds[facet] * std::sqrt(squared_length);
    return {value, is_exact_ ? bound + internal::kUnderflowSlack
                             : std::numeric_limits<double>::infinity()};
  }

 private:
  const Impl& impl_;
  int rank_;
  bool is_exact_;
  std::array<double, kMaxDimension> coordinates_ = {};
};

struct ExactSide {
  int sign = 0;           // positive outside
  double distance = 0.0;  // from the facet's plane, negative outside. Rounded
};

/// The side of a point of the span, by integers.
ExactSide exact_side(const Impl& impl, Index facet, const Eigen::Ref<const VectorXd>& point) {
  const auto rank = static_cast<Index>(impl.axes.size());
  MatrixXd corners_and_point(rank, rank + 1);
  std::array<int, kMaxDimension> corners;
  for (Index k = 0; k < rank; ++k) corners[static_cast<std::size_t>(k)] = static_cast<int>(k);
  for (Index j = 0; j < rank; ++j) {
    const int axis = impl.axes[static_cast<std::size_t>(j)];
    for (Index k = 0; k < rank; ++k) {
      corners_and_point(j, k) = impl.points(axis, impl.facets(k, facet));
    }
    corners_and_point(j, rank) = point[axis];
  }
  IntegerPoints exact(corners_and_point);
  IntegerHyperplane plane;
  exact.hyperplane({corners.data(), static_cast<std::size_t>(rank)}, plane);
  const internal::BinaryParts value = exact.evaluate(plane, static_cast<int>(rank));
  std::array<long, kMaxDimension> exponents;
  long largest = std::numeric_limits<long>::min();
  VectorXd gradient(rank);
  for (Index j = 0; j < rank; ++j) {
    const auto [mantissa, exponent] = plane.normal_parts[static_cast<std::size_t>(j)];
    gradient[j] = mantissa;
    exponents[static_cast<std::size_t>(j)] = exponent + exact.scale(static_cast<int>(j));
    if (mantissa != 0.0) largest = std::max(largest, exponents[static_cast<std::size_t>(j)]);
  }
  for (Index j = 0; j < rank; ++j) {
    const long shift = exponents[static_cast<std::size_t>(j)] - largest;
    gradient[j] = std::ldexp(gradient[j], static_cast<int>(std::max(shift, -2000L)));
  }
  const auto [mantissa, exponent] = value;
  const double scaled =
      std::ldexp(mantissa, static_cast<int>(std::clamp(exponent - largest, -2000L, 2000L)));
  ExactSide side;
  // A single corner has no order that could tell outside.
  const int orientation = rank == 1 && impl.gradients(0, facet) < 0.0 ? -1 : 1;
  side.sign = orientation * ((mantissa > 0.0) - (mantissa < 0.0));
  side.distance = -orientation * scaled / (directions_on_axes(impl).transpose() * gradient).norm();
  if (side.sign != 0 && side.distance == 0.0) {  // too small for a double is not nothing
    side.distance = -side.sign * std::numeric_limits<double>::min();
  }
  return side;
}

/// Whether a point lies in the span of a hull of lower rank.
bool is_in_span(const Impl& impl, const Eigen::Ref<const VectorXd>& point) {
  const auto count = static_cast<Index>(impl.independent.size());
  MatrixXd spanning(impl.dimension(), count + 1);
  for (Index k = 0; k < count; ++k) {
    spanning.col(k) = impl.points.col(impl.independent[static_cast<std::size_t>(k)]);
  }
  spanning.col(count) = point;
  const IntegerPoints exact(spanning);
  IntegerEchelon echelon(exact.dimension(), scales_of(exact));
  for (int k = 1; k < count; ++k) echelon.add(exact.point(k));
  return !echelon.add(exact.point(static_cast<int>(count)));
}

/// Distance from the nearest facet of a point of the span, negative outside; see `inradius`.
double distance_within_span(const Impl& impl, const Eigen::Ref<const VectorXd>& point) {
  const ScaledPoint scaled(impl, point);
  const Index count = impl.facets.cols();
  std::vector<std::pair<double, double>> ranges;  // lowest and highest possible distance
  double nearest = std::numeric_limits<double>::infinity();
  for (Index f = 0; f < count; ++f) {
    const SideValue side = scaled.side(f);
    ranges.emplace_back(-(side.value + side.bound) * impl.stretches[f],
                        -(side.value - side.bound) * impl.stretches[f]);
    nearest = std::min(nearest, ranges.back().second);
  }
  double distance = std::numeric_limits<double>::infinity();
  for (Index f = 0; f < count; ++f) {
    const auto [low, high] = ranges[static_cast<std::size_t>(f)];
    if (low > nearest) continue;
    const double middle = 0.5 * (low + high);
    const bool is_precise = high - low <= internal::kNormalPrecision * std::abs(middle);
    distance = std::min(distance, is_precise ? middle : exact_side(impl, f, point).distance);
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
  auto impl = std::make_shared<Impl>();
  impl->points = points;
  const std::vector<int> chosen = distinct_points(impl->points);
  if (chosen.size() == 1) {
    impl->rank = 0;
    impl->vertices = chosen;
    impl->independent = chosen;
  } else if (chosen.size() > 1) {
    impl->axes.resize(static_cast<std::size_t>(points.rows()));
    std::iota(impl->axes.begin(), impl->axes.end(), 0);
    if (!build_in_axes(chosen, *impl)) {
      impl->axes = span_of(impl->points, impl->axes, chosen).axes;
      build_in_axes(chosen, *impl);
    }
    impl->rank = static_cast<int>(impl->axes.size());
    measure_in_space(*impl);
  }
  impl_ = std::move(impl);
}

int ConvexPolytope::dimension() const { return impl_->dimension(); }
int ConvexPolytope::rank() const { return impl_->rank; }
const MatrixXd& ConvexPolytope::points() const { return impl_->points; }
const std::vector<int>& ConvexPolytope::vertices() const { return impl_->vertices; }
const Eigen::MatrixXi& ConvexPolytope::facets() const { return impl_->facets; }
const Eigen::MatrixXi& ConvexPolytope::neighbors() const { return impl_->neighbors; }
const MatrixXd& ConvexPolytope::normals() const { return impl_->normals; }
const VectorXd& ConvexPolytope::offsets() const { return impl_->offsets; }
double ConvexPolytope::measure() const { return impl_->measure; }
double ConvexPolytope::volume() const { return rank() == dimension() ? measure() : 0.0; }

Containment ConvexPolytope::containment(const Eigen::Ref<const VectorXd>& point) const {
  require_finite(point, dimension(), "containment");
  if (rank() < 0) return Containment::Outside;
  if (rank() < dimension() && !is_in_span(*impl_, point)) return Containment::Outside;
  const ScaledPoint scaled(*impl_, point);
  std::vector<Index> uncertain;
  for (Index f = 0; f < impl_->facets.cols(); ++f) {
    const SideValue side = scaled.side(f);
    if (!side.is_certain()) {
      uncertain.push_back(f);
    } else if (side.value > 0.0) {
      return Containment::Outside;
    }
  }
  bool is_on_surface = rank() < dimension();
  for (const Index f : uncertain) {
    const int sign = exact_side(*impl_, f, point).sign;
    if (sign > 0) return Containment::Outside;
    is_on_surface = is_on_surface || sign == 0;
  }
  return is_on_surface ? Containment::OnSurface : Containment::Inside;
}

double ConvexPolytope::inradius(const Eigen::Ref<const VectorXd>& point) const {
  require_finite(point, dimension(), "inradius");
  if (rank() < 0) return -std::numeric_limits<double>::infinity();
  if (rank() == 0) return -(point - impl_->points.col(impl_->vertices[0])).stableNorm();
  const double within = distance_within_span(*impl_, point);
  if (rank() == dimension()) return within;
  if (is_in_span(*impl_, point)) return std::min(within, 0.0);
  const VectorXd difference = point - impl_->points.col(impl_->independent[0]);
  const VectorXd along = impl_->directions.transpose() * difference;
  const double from_span = (difference - impl_->directions * along).stableNorm();
  return std::min(-std::max(from_span, std::numeric_limits<double>::min()), within);
}

}  // namespace graspfit::geometry
