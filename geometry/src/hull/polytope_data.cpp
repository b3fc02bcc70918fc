#include "hull/polytope_data.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "graspfit/base/as_index.hpp"
#include "hull/hull_builder.hpp"

namespace graspfit::geometry::internal {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::array<int, kMaxDimension> scales_of(const IntegerPoints& points) {
  std::array<int, kMaxDimension> scales = {};
  for (int j = 0; j < points.dimension(); ++j) scales[j] = points.scale(j);
  return scales;
}

namespace {

/// Indices of distinct points in lexicographic order, of equal ones the lowest.
std::vector<int> distinct_points(const MatrixXd& points) {
  std::vector<int> order(points.cols());
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

/// Whether the normals of some facets span all of the space, by doubles with a safety margin. Their
/// determinant is the product of the distances of each normal from the span of those before. If the
/// exact normals miss a direction, each rounded one has at most 2^-36 along it, and the determinant
/// is at most 6 * 2^-36 < 2^-33; with lengths above 2^-20 the orthogonalization adds less than
/// 2^-27.
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

/// The hull of distinct points `chosen` that span `PolytopeData::axes`.
template <int D>
class SpanHull {
 public:
  SpanHull(const MatrixXd& points, const std::vector<int>& axes, const std::vector<int>& chosen)
      : coordinates_(points(axes, chosen)),
        scaled_(coordinates_),
        exact_(coordinates_),
        is_exactly_scaled_(scale_rows(scaled_, exponents_)),
        builder_(scaled_, exponents_, exact_, is_exactly_scaled_) {}

  /// Builds the hull from `simplex`, or from a spread simplex if `simplex` is empty; false if the
  /// simplex is degenerate.
  bool build(std::vector<int> simplex) {
    if (simplex.empty()) simplex = builder_.spread_simplex();
    if (simplex.size() != D + 1 || !builder_.build(simplex)) return false;
    simplex_ = simplex;
    facets_ = builder_.facets();
    return true;
  }

  /// The corners of facets that are extreme points; the others lie within larger facets.
  std::vector<int> extreme_corners() {
    std::vector<std::vector<int>> stars(coordinates_.cols());
    for (const int f : facets_) {
      for (const int corner : builder_.simplex(f).corners) stars[corner].push_back(f);
    }
    std::vector<int> extreme;
    for (int corner = 0; corner < std::ssize(stars); ++corner) {
      if (!stars[corner].empty() && is_extreme(stars[corner])) {
        extreme.push_back(corner);
      }
    }
    return extreme;
  }

  int num_corners() const {
    std::vector<bool> used(coordinates_.cols(), false);
    for (const int f : facets_) {
      for (const int corner : builder_.simplex(f).corners) used[corner] = true;
    }
    return static_cast<int>(std::count(used.begin(), used.end(), true));
  }

  /// Facets in their final order, with point indices looked up in `chosen`.
  void store(const std::vector<int>& chosen, PolytopeData& data) {
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
    std::vector<int> index_of(builder_.num_created(), -1);
    for (int i = 0; i < std::ssize(sorted); ++i) index_of[sorted[i].facet] = i;

    const auto count = std::ssize(sorted);
    data.facets.resize(D, count);
    data.neighbors.resize(D, count);
    data.gradients.resize(D, count);
    data.unit_bounds.resize(count);
    for (Index i = 0; i < count; ++i) {
      const Sorted& s = sorted[i];
      const auto& plane = builder_.precise_plane(s.facet);
      for (int k = 0; k < D; ++k) {
        data.facets(k, i) = s.corners[k];
        data.neighbors(k, i) = index_of[builder_.simplex(s.facet).neighbors[s.slots[k]]];
        data.gradients(k, i) = plane.normal[k];
      }
      data.unit_bounds[i] = builder_.unit_bound(s.facet);
    }
    data.exponents = exponents_;
    data.has_scaled_points = is_exactly_scaled_;
    data.independent.clear();
    for (const int i : simplex_) data.independent.push_back(chosen[i]);
    double factor = 1.0;  // of the volume: 1 / D! and the scale of each axis
    for (int j = 0; j < D; ++j) factor *= std::ldexp(1.0 / (j + 1), exponents_[j]);
    data.measure = factor * builder_.scaled_volume(facets_);
  }

 private:
  /// A corner is extreme if the planes of the facets around it have no other common point.
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
  HullBuilder<D> builder_;
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
  const IntegerPoints exact(points(axes, chosen));
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

/// The hull in `PolytopeData::axes`; null if the points span less than these.
template <int D>
std::unique_ptr<SpanHull<D>> built_hull(const PolytopeData& data, const std::vector<int>& chosen) {
  if (chosen.size() <= D) return nullptr;
  auto hull = std::make_unique<SpanHull<D>>(data.points, data.axes, chosen);
  if (hull->build({})) return hull;
  const Span span = span_of(data.points, data.axes, chosen);
  if (span.axes.size() < D) return nullptr;
  hull = std::make_unique<SpanHull<D>>(data.points, data.axes, chosen);
  return hull->build(span.independent) ? std::move(hull) : nullptr;
}

/// Facets and vertices; false if the points span less than `PolytopeData::axes`.
template <int D>
bool build_facets(std::vector<int> chosen, PolytopeData& data) {
  std::unique_ptr<SpanHull<D>> hull = built_hull<D>(data, chosen);
  if (!hull) return false;
  std::vector<int> extreme = hull->extreme_corners();
  const bool is_tight = std::ssize(extreme) == hull->num_corners();
  for (int& i : extreme) i = chosen[i];
  if (!is_tight) {
    chosen = extreme;
    hull = built_hull<D>(data, chosen);
  }
  hull->store(chosen, data);
  data.vertices = std::move(extreme);
  std::sort(data.vertices.begin(), data.vertices.end());
  return true;
}

/// A segment's facets are its ends, the first and the last point in the order of one axis.
void build_segment(const std::vector<int>& chosen, PolytopeData& data) {
  const MatrixXd coordinates = data.points(data.axes, chosen);
  Index low = 0;
  Index high = 0;
  coordinates.row(0).minCoeff(&low);
  coordinates.row(0).maxCoeff(&high);
  data.independent = {chosen[low], chosen[high]};
  const bool is_rising = chosen[low] < chosen[high];
  data.vertices = data.independent;
  std::sort(data.vertices.begin(), data.vertices.end());
  data.facets.resize(1, 2);
  data.facets << data.vertices[0], data.vertices[1];
  data.neighbors.resize(1, 2);
  data.neighbors << 1, 0;
  data.gradients.resize(1, 2);
  data.gradients << (is_rising ? -1.0 : 1.0), (is_rising ? 1.0 : -1.0);
  data.unit_bounds = VectorXd::Constant(2, kSideUnits * 0x1p-53);  // 1 unit is needed
  data.measure = coordinates(0, high) - coordinates(0, low);
}

bool build_in_axes(const std::vector<int>& chosen, PolytopeData& data) {
  switch (data.axes.size()) {
    case 1:
      build_segment(chosen, data);
      return true;
    case 2:
      return build_facets<2>(chosen, data);
    case 3:
      return build_facets<3>(chosen, data);
    case 4:
      return build_facets<4>(chosen, data);
    case 5:
      return build_facets<5>(chosen, data);
    case 6:
      return build_facets<6>(chosen, data);
    default:
      return false;
  }
}

/// Computes what is measured in the space rather than on `axes`: normals, distances, the volume in
/// the span.
void measure_in_space(PolytopeData& data) {
  const auto rank = std::ssize(data.axes);
  const bool is_full = rank == data.dimension();
  if (is_full) {
    data.directions = MatrixXd::Identity(rank, rank);
  } else {
    MatrixXd edges(data.dimension(), rank);
    for (Index k = 0; k < rank; ++k) {
      edges.col(k) =
          (data.points.col(data.independent[k + 1]) - data.points.col(data.independent[0]))
              .stableNormalized();
    }
    data.directions = Eigen::HouseholderQR<MatrixXd>(edges).householderQ() *
                      MatrixXd::Identity(edges.rows(), rank);
  }
  const MatrixXd on_axes = directions_on_axes(data);
  data.measure /= std::abs(on_axes.determinant());
  data.normals.resize(data.dimension(), data.facets.cols());
  data.offsets.resize(data.facets.cols());
  data.distance_factors.resize(data.facets.cols());
  VectorXd gradient(rank);
  for (Index f = 0; f < data.facets.cols(); ++f) {
    gradient = data.gradients.col(f);
    for (Index j = 0; j < rank; ++j) {
      gradient[j] = std::ldexp(gradient[j], -data.exponents[j]);
    }
    if (is_full) {
      gradient.array() += 0.0;  // no negative zeros, which the products leave none of either
    } else {
      gradient = on_axes.transpose() * gradient;
    }
    const double length = gradient.stableNorm();
    data.distance_factors[f] = 1.0 / length;
    gradient /= length;
    if (is_full) {
      data.normals.col(f) = gradient;
    } else {
      data.normals.col(f) = data.directions * gradient;
    }
    data.offsets[f] = data.normals.col(f).dot(data.points.col(data.facets(0, f)));
  }
}

}  // namespace

PolytopeData polytope_data(const Eigen::Ref<const MatrixXd>& points) {
  PolytopeData data;
  data.points = points;
  const std::vector<int> chosen = distinct_points(data.points);
  if (chosen.size() == 1) {
    data.rank = 0;
    data.vertices = chosen;
    data.independent = chosen;
  } else if (chosen.size() > 1) {
    data.axes.resize(points.rows());
    std::iota(data.axes.begin(), data.axes.end(), 0);
    if (!build_in_axes(chosen, data)) {
      data.axes = span_of(data.points, data.axes, chosen).axes;
      build_in_axes(chosen, data);
    }
    data.rank = base::as_index<int>(data.axes.size());
    measure_in_space(data);
  }
  return data;
}

MatrixXd directions_on_axes(const PolytopeData& data) {
  return data.directions(data.axes, Eigen::seqN(0, data.directions.cols()));
}

}  // namespace graspfit::geometry::internal
