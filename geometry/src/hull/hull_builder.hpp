#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "graspfit/base/as_index.hpp"
#include "hull/exact_hyperplane.hpp"

/// \file
/// The boundary of the convex hull of points that span their space, as a triangulated sphere.

namespace graspfit::geometry::internal {

/// Upper bound of the permanent of an n × n matrix with unit rows, which bounds the determinants
/// below: the permanent is at most n! / n^(n/2) times the product of the rows' lengths [Carlen,
/// Lieb & Loss 2006].
inline constexpr std::array<double, kMaxDimension + 1> kPermanentFactor = {1.0, 1.0,  1.0, 1.16,
                                                                           1.5, 2.15, 3.34};

/// Rounding errors of a side value, in units of 2^-53 times that permanent. A minor of k rows is
/// off by e_k units: e_1 = 1 (the difference of coordinates), e_k = e_{k−1} + k + 1, so e_5 = 19.
/// A coefficient times a rounded difference adds 2, and the six additions of a side value 6: 27 for
/// the point; 26 for the offset, plus the same six additions: 59. The rest covers the rounding of
/// the bound itself, 32 times 2^-53 of it.
inline constexpr double kSideUnits = 64.0;

/// What underflow may add where coordinates are scaled to about one: fewer than a thousand products
/// lose up to 2^-1075 each, times coordinates below 2^8 in all, so less than 2^-1057.
inline constexpr double kUnderflowSlack = 0x1p-960;

/// Products of squared lengths below this may have lost bits to underflow, and bound nothing.
inline constexpr double kLeastSquaredProduct = 0x1p-960;

/// A plane's coefficients that are less precise than this (1.5e-11), relative to their length, are
/// recomputed from integers before they become a normal.
inline constexpr double kNormalPrecision = 0x1p-36;

/// Plane of a facet, which gives a scaled point x its side value normal · (x − x_0) − offset,
/// positive outside.
template <int D>
struct FacetPlane {
  std::array<double, D> normal;
  double offset;
  double bound;  ///< The exact sign is that of any side value larger than this in magnitude.
};

/// A simplicial facet.
template <int D>
struct HullSimplex {
  std::array<int, D> corners;    ///< det(p_1 − p_0, …, p_{D−1} − p_0, outward normal) > 0.
  std::array<int, D> neighbors;  ///< Opposite to each corner.
};

/// Quickhull [Barber, Dobkin & Huhdanpaa 1996] with exact decisions: a facet is replaced only when
/// a point is strictly beyond it, so that no facet ever degenerates and no facets need merging,
/// however the points lie. Signs come from doubles with a proven bound, else from integers.
template <int D>
class HullBuilder {
 public:
  /// `points`: D × n, distinct, scaled by powers of two to a range of about one per axis, without
  /// rounding unless `filter` is off. `exact`: the same points, times 2^(scale + exponent).
  HullBuilder(const Eigen::MatrixXd& points, const std::array<int, kMaxDimension>& exponents,
              IntegerPoints& exact, bool filter)
      : exact_(exact), filter_(filter), points_(points.cols()) {
    for (Eigen::Index i = 0; i < std::ssize(points_); ++i) {
      for (int j = 0; j < D; ++j) points_[i][j] = points(j, i);
    }
    differences_ = points_;
    double squared_radius = 0.0;
    for (Point& x : differences_) {
      double squared = 0.0;
      for (int j = 0; j < D; ++j) {
        x[j] -= points_[0][j];
        squared += x[j] * x[j];
      }
      squared_radius = std::max(squared_radius, squared);
    }
    radius_ = std::sqrt(squared_radius);
    for (int j = 0; j < D; ++j) lattice_exponents_[j] = exact.scale(j) + exponents[j];
  }

  /// Builds the hull from a simplex of D + 1 of the points; false if these are dependent.
  bool build(std::span<const int> simplex) {
    if (!start(simplex)) return false;
    // Facets are only ever appended, so one pass sees all that get points.
    for (int f = 0; f < std::ssize(simplices_); ++f) {
      if (is_alive(f) && first_outside_[f] >= 0) {
        insert(farthest_outside(f), f);
      }
    }
    return true;
  }

  /// D + 1 points far from each other's span, by rounded arithmetic: usually independent.
  std::vector<int> spread_simplex() const {
    using Vector = Eigen::Matrix<double, D, 1>;
    std::vector<Vector> rest(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      rest[i] = Eigen::Map<const Vector>(differences_[i].data());
    }
    const auto farthest = [&] {
      std::size_t best = 0;
      for (std::size_t i = 1; i < rest.size(); ++i) {
        if (rest[i].squaredNorm() > rest[best].squaredNorm()) best = i;
      }
      return best;
    };
    std::vector<int> simplex = {static_cast<int>(farthest())};
    const Vector base = rest[simplex[0]];
    for (Vector& x : rest) x -= base;
    for (int k = 0; k < D; ++k) {
      const std::size_t next = farthest();
      const double length = rest[next].norm();
      if (!(length > 0.0)) break;
      const Vector direction = rest[next] / length;
      for (Vector& x : rest) x -= direction.dot(x) * direction;
      simplex.push_back(static_cast<int>(next));
    }
    return simplex;
  }

  /// Numbers of the facets of the hull, ascending; the others were replaced.
  std::vector<int> facets() const {
    std::vector<int> alive;
    for (int f = 0; f < std::ssize(simplices_); ++f) {
      if (is_alive(f)) alive.push_back(f);
    }
    return alive;
  }

  const HullSimplex<D>& simplex(int facet) const { return simplices_[facet]; }

  /// The facet's plane, with a direction precise to `kNormalPrecision`.
  const FacetPlane<D>& precise_plane(int facet) {
    if (planes_[facet].bound > kNormalPrecision * radius_ * length(planes_[facet])) refine(facet);
    return planes_[facet];
  }

  /// The normal of the facet's plane in integers, for exact work.
  IntegerVector exact_normal(int facet) {
    refine(facet);
    return exact_.normal(integer_planes_[exact_index_[facet]]);
  }

  /// D! times the volume of the hull in scaled coordinates: the cones from the first point over
  /// all facets, none of them negative.
  double scaled_volume(std::span<const int> facets) {
    double sum = 0.0;
    double error = 0.0;
    for (const int f : facets) {
      sum += planes_[f].offset;
      error += planes_[f].bound;
    }
    if (error <= kNormalPrecision * sum) return sum;
    sum = 0.0;
    for (const int f : facets) {
      refine(f);
      sum += planes_[f].offset;
    }
    return sum;
  }

  /// Error bound of a side value per length of the difference of a point from a corner.
  double unit_bound(int facet) const { return planes_[facet].bound / radius_; }

  int num_created() const { return base::as_index<int>(simplices_.size()); }

 private:
  using Point = std::array<double, D>;
  using Plane = FacetPlane<D>;

  static double length(const Plane& plane) {
    double squared = 0.0;
    for (const double c : plane.normal) squared += c * c;
    return std::sqrt(squared);
  }

  bool is_alive(int facet) const { return visible_step_[facet] == kNever; }

  double side_value(int facet, int point) const {
    const Plane& plane = planes_[facet];
    const Point& x = differences_[point];
    double value = -plane.offset;
    for (int j = 0; j < D; ++j) value += plane.normal[j] * x[j];
    return value;
  }

  /// Sign of the side value in doubles; 0 if the filter does not decide.
  int filtered_side(int facet, int point) const {
    const double value = side_value(facet, point);
    const double bound = planes_[facet].bound;
    return (value > bound) - (value < -bound);
  }

  int exact_side(int facet, int point) {
    if (exact_index_[facet] < 0) {
      refine(facet);
      if (const int side = filtered_side(facet, point); side != 0) return side;
    }
    const double value = exact_.evaluate(integer_planes_[exact_index_[facet]], point).first;
    return (value > 0.0) - (value < 0.0);
  }

  int side(int facet, int point) {
    if (const int certain = filtered_side(facet, point); certain != 0) return certain;
    return exact_side(facet, point);
  }

  template <unsigned Set, std::size_t... J>
  static double minor_of(const double* row, const double* minors, std::index_sequence<J...>) {
    constexpr int size = std::popcount(Set);
    double sum = 0.0;
    const auto add = [&]<std::size_t j>(std::integral_constant<std::size_t, j>) {
      if constexpr ((Set >> j & 1U) != 0) {
        constexpr int position = std::popcount(Set & ((1U << j) - 1U));
        const double term = row[j] * minors[Set ^ (1U << j)];
        if constexpr ((size - 1 + position) % 2 == 0) {
          sum += term;
        } else {
          sum -= term;
        }
      }
    };
    (add(std::integral_constant<std::size_t, J>{}), ...);
    return sum;
  }

  /// All minors of the first |S| rows in the columns S, for 0 < S < 2^D − 1 in order, so that
  /// smaller minors are computed first; the loop is unrolled.
  template <std::size_t... S>
  static void expand_minors(const std::array<Point, D - 1>& rows, double* minors,
                            std::index_sequence<S...>) {
    minors[0] = 1.0;
    ((minors[S + 1] = minor_of<static_cast<unsigned>(S + 1)>(
          rows[std::popcount(static_cast<unsigned>(S + 1)) - 1].data(), minors,
          std::make_index_sequence<D>{})),
     ...);
  }

  void compute_plane(const HullSimplex<D>& simplex, Plane& plane) const {
    const Point& base = points_[simplex.corners[0]];
    std::array<Point, D - 1> rows;
    double product = 1.0;  // of squared lengths
    for (int k = 1; k < D; ++k) {
      const Point& x = points_[simplex.corners[k]];
      double squared = 0.0;
      for (int j = 0; j < D; ++j) {
        rows[k - 1][j] = x[j] - base[j];
        squared += rows[k - 1][j] * rows[k - 1][j];
      }
      product *= squared;
    }
    constexpr unsigned kFull = (1U << D) - 1U;
    std::array<double, kFull> minors;
    expand_minors(rows, minors.data(), std::make_index_sequence<kFull - 1>{});
    const Point& x0 = differences_[simplex.corners[0]];
    plane.offset = 0.0;
    for (int j = 0; j < D; ++j) {
      const double minor = minors[kFull ^ (1U << j)];
      plane.normal[j] = (D - 1 + j) % 2 == 0 ? minor : -minor;
      plane.offset += plane.normal[j] * x0[j];
    }
    plane.bound = filter_ && product >= kLeastSquaredProduct
                      ? kSideUnits * 0x1p-53 * kPermanentFactor[D] * std::sqrt(product) * radius_ +
                            kUnderflowSlack
                      : std::numeric_limits<double>::infinity();
  }

  /// Recomputes the plane from integers: direction and offset are then right to an ulp.
  void refine(int facet) {
    if (exact_index_[facet] >= 0) return;
    if (free_planes_.empty()) {
      free_planes_.push_back(base::as_index<int>(integer_planes_.size()));
      integer_planes_.emplace_back();
    }
    exact_index_[facet] = free_planes_.back();
    free_planes_.pop_back();
    IntegerHyperplane& exact = integer_planes_[exact_index_[facet]];
    exact_.hyperplane(simplices_[facet].corners, exact);
    Plane& plane = planes_[facet];
    const long all_axes =
        std::accumulate(lattice_exponents_.begin(), lattice_exponents_.begin() + D, 0L);
    const auto rounded = [&](const BinaryParts& parts, long exponent_of_two) {
      const auto [mantissa, exponent] = parts;
      return std::ldexp(mantissa, static_cast<int>(std::clamp(exponent - exponent_of_two,
                                                              long{-2000}, long{2000})));
    };
    for (int j = 0; j < D; ++j) {
      plane.normal[j] = rounded(exact.normal_parts[j], all_axes - lattice_exponents_[j]);
    }
    plane.offset = rounded(exact.offset_parts, all_axes);
    const double scale = length(plane);
    // Coefficients are cut to 2 units: a side value is off by 2 D + 6, at most 18, of 64.
    plane.bound = filter_ && scale > 0x1p-900
                      ? kSideUnits * 0x1p-53 * scale * radius_ + kUnderflowSlack
                      : std::numeric_limits<double>::infinity();
  }

  int add_facet(const HullSimplex<D>& simplex) {
    const int id = base::as_index<int>(simplices_.size());
    simplices_.push_back(simplex);
    planes_.emplace_back();
    compute_plane(simplex, planes_.back());
    exact_index_.push_back(-1);
    first_outside_.push_back(-1);
    visible_step_.push_back(kNever);
    seen_step_.push_back(kNever);
    return id;
  }

  bool start(std::span<const int> simplex) {
    assert(simplex.size() == D + 1);
    next_outside_.assign(points_.size(), -1);
    for (int i = 0; i <= D; ++i) {
      HullSimplex<D> facet;
      for (int k = 0; k < D; ++k) {
        facet.corners[k] = simplex[k < i ? k : k + 1];
        facet.neighbors[k] = k < i ? k : k + 1;  // the facet without that corner
      }
      int id = add_facet(facet);
      const int apex_side = side(id, simplex[i]);
      if (apex_side == 0) return false;
      if (apex_side > 0) {
        drop_integers(id);
        std::swap(simplices_[id].corners[0], simplices_[id].corners[1]);
        std::swap(simplices_[id].neighbors[0], simplices_[id].neighbors[1]);
        compute_plane(simplices_[id], planes_[id]);
      }
    }
    for (int p = 0; p < std::ssize(points_); ++p) {
      if (std::find(simplex.begin(), simplex.end(), p) == simplex.end()) assign(p, 0);
    }
    return true;
  }

  /// Puts a point on the list of the first facet from `first` on that it is strictly beyond. If a
  /// point is beyond none of the facets that replaced the ones it was beyond, it is in the hull
  /// from then on.
  void assign(int point, int first) {
    uncertain_.clear();
    for (int f = first; f < std::ssize(simplices_); ++f) {
      const double value = side_value(f, point);
      const double bound = planes_[f].bound;
      if (value > bound) return push_outside(f, point);
      if (value >= -bound) uncertain_.push_back(f);
    }
    for (const int f : uncertain_) {
      if (exact_side(f, point) > 0) return push_outside(f, point);
    }
  }

  void push_outside(int facet, int point) {
    next_outside_[point] = first_outside_[facet];
    first_outside_[facet] = point;
  }

  int farthest_outside(int facet) const {
    int best = first_outside_[facet];
    double largest = side_value(facet, best);
    for (int p = next_outside_[best]; p >= 0; p = next_outside_[p]) {
      const double value = side_value(facet, p);
      if (value > largest || (value == largest && p < best)) {
        best = p;
        largest = value;
      }
    }
    return best;
  }

  int slot_of_corner(int facet, int corner) const {
    const auto& corners = simplices_[facet].corners;
    return static_cast<int>(std::find(corners.begin(), corners.end(), corner) - corners.begin());
  }
  int slot_of_neighbor(int facet, int neighbor) const {
    const auto& all = simplices_[facet].neighbors;
    return static_cast<int>(std::find(all.begin(), all.end(), neighbor) - all.begin());
  }

  /// Replaces the facets visible from `point`, a connected set that holds `seed`, by the cone from
  /// `point` over the rim of that set.
  void insert(int point, int seed) {
    ++step_;
    const int first_new = base::as_index<int>(simplices_.size());
    visible_.assign(1, seed);
    visible_step_[seed] = step_;
    for (std::size_t k = 0; k < visible_.size(); ++k) {
      for (const int g : simplices_[visible_[k]].neighbors) {
        if (visible_step_[g] == step_ || seen_step_[g] == step_) continue;
        seen_step_[g] = step_;
        if (side(g, point) <= 0) continue;
        visible_step_[g] = step_;
        visible_.push_back(g);
      }
    }
    cone_.resize(simplices_.size() * D);
    for (const int f : visible_) {
      for (int i = 0; i < D; ++i) {
        const int g = simplices_[f].neighbors[i];
        if (visible_step_[g] == step_) continue;
        HullSimplex<D> facet = simplices_[f];
        facet.corners[i] = point;  // keeps the orientation: corner i is on the other side now
        const int id = add_facet(facet);
        cone_[static_cast<std::size_t>(f) * D + i] = id;
        simplices_[g].neighbors[slot_of_neighbor(g, f)] = id;
        rim_.push_back({f, i});
      }
    }
    for (int k = 0; k < std::ssize(rim_); ++k) {
      const auto [f, i] = rim_[k];
      for (int j = 0; j < D; ++j) {
        if (j == i) continue;
        simplices_[first_new + k].neighbors[j] = across_rim(f, i, j);
      }
    }
    rim_.clear();
    for (const int f : visible_) {
      for (int p = first_outside_[f]; p >= 0;) {
        const int next = next_outside_[p];
        if (p != point) assign(p, first_new);
        p = next;
      }
      drop_integers(f);
    }
  }

  /// The neighbor opposite to corner j of the new facet over the rim ridge (f, i). The search turns
  /// around the corners of f other than i and j through visible facets until it meets the rim
  /// again.
  int across_rim(int f, int i, int j) const {
    int kept = simplices_[f].corners[i];
    int exit = j;
    for (;;) {
      const int g = simplices_[f].neighbors[exit];
      if (visible_step_[g] != step_) return cone_[static_cast<std::size_t>(f) * D + exit];
      const int entered = slot_of_neighbor(g, f);
      exit = slot_of_corner(g, kept);
      kept = simplices_[g].corners[entered];
      f = g;
    }
  }

  void drop_integers(int facet) {
    if (exact_index_[facet] < 0) return;
    free_planes_.push_back(exact_index_[facet]);
    exact_index_[facet] = -1;
  }

  static constexpr int kNever = -1;

  IntegerPoints& exact_;
  bool filter_;
  std::array<int, kMaxDimension> lattice_exponents_ = {};
  std::vector<Point> points_;
  std::vector<Point> differences_;  // rounded, from the first point
  double radius_ = 0.0;             // largest length of these

  std::vector<HullSimplex<D>> simplices_;
  std::vector<Plane> planes_;
  std::vector<int> exact_index_;    // into integer_planes_, −1 until needed
  std::vector<int> first_outside_;  // per facet the first of a list of points beyond it, or −1
  std::vector<int> next_outside_;   // per point the next one of its list, or −1
  std::vector<int> visible_step_;   // when the facet was replaced
  std::vector<int> seen_step_;      // when last found not visible
  std::deque<IntegerHyperplane> integer_planes_;
  std::vector<int> free_planes_;

  int step_ = 0;
  std::vector<int> visible_;
  std::vector<int> uncertain_;
  std::vector<std::pair<int, int>> rim_;  // ridges between visible and hidden, by visible facet
  std::vector<int> cone_;                 // per visible facet and corner: the facet over that ridge
};

}  // namespace graspfit::geometry::internal
