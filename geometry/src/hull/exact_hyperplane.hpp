#pragma once

#include <gmp.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "graspfit/base/as_index.hpp"

/// \file
/// Hyperplanes through points with double coordinates, in integers: coordinates are differences of
/// multiples of one power of two per axis, so no division and no common divisor is ever needed.

namespace graspfit::geometry::internal {

/// Largest dimension of a polytope.
inline constexpr int kMaxDimension = 6;

/// A number as mantissa in [0.5, 1) in magnitude, cut to 53 bits, and exponent of two; 0 for zero,
/// so that the mantissa has the sign of the number.
using BinaryParts = std::pair<double, long>;

/// An integer of any size. `mpz()` is for GMP's own functions, which work in place.
class Integer {
 public:
  Integer() { mpz_init(value_); }
  Integer(const Integer& other) { mpz_init_set(value_, other.value_); }
  Integer(Integer&& other) noexcept {
    mpz_init(value_);
    mpz_swap(value_, other.value_);
  }
  Integer& operator=(Integer other) noexcept {
    mpz_swap(value_, other.value_);
    return *this;
  }
  ~Integer() { mpz_clear(value_); }

  mpz_ptr mpz() { return value_; }
  mpz_srcptr mpz() const { return value_; }
  int sign() const { return mpz_sgn(value_); }

  BinaryParts parts() const {
    long exponent = 0;
    const double mantissa = mpz_get_d_2exp(&exponent, value_);
    return {mantissa, exponent};
  }

 private:
  mpz_t value_;
};

using IntegerVector = std::array<Integer, kMaxDimension>;

/// A number of six 64-bit digits or fewer, two's complement, lowest first.
using Digits = std::array<std::uint64_t, kMaxDimension>;

/// A number and its negative, so that only magnitudes need be multiplied.
using SignedDigits = std::array<Digits, 2>;

/// normal · z − offset for integer points z, positive where det(p_1 − p_0, …, p_{d−1} − p_0, z −
/// p_0) is: on the outer side of a facet whose corners are in outward order.
struct IntegerHyperplane {
  std::array<BinaryParts, kMaxDimension> normal_parts;
  BinaryParts offset_parts;

  // The exact numbers, as `base` and `digits` or as `normal` and `offset`: see IntegerPoints.
  int base = 0;  // a corner
  std::array<SignedDigits, kMaxDimension> digits;
  IntegerVector normal;
  Integer offset;
};

/// Points on an integer lattice: z_ij = 2^scale_j (p_ij − p_0j), without rounding.
class IntegerPoints {
 public:
  /// One point a column, at least one, all finite; the first becomes the origin.
  explicit IntegerPoints(const Eigen::Ref<const Eigen::MatrixXd>& points);

  int dimension() const { return dimension_; }
  int size() const { return base::as_index<int>(points_.size()); }
  int scale(int axis) const { return scales_[axis]; }
  const IntegerVector& point(int index) const { return points_[index]; }

  /// The hyperplane through as many points as there are axes. All zero if these points are affinely
  /// dependent.
  void hyperplane(std::span<const int> corners, IntegerHyperplane& result);

  /// normal · z_index − offset.
  BinaryParts evaluate(const IntegerHyperplane& plane, int index);

  /// The exact normal of a hyperplane through these points.
  IntegerVector normal(const IntegerHyperplane& plane) const;

 private:
  using NarrowPoint = std::array<std::int64_t, kMaxDimension>;

  bool is_narrow() const { return !narrow_points_.empty(); }
  void find_minors(std::span<const int> corners);
  void find_narrow_minors(std::span<const int> corners);
  void wide_hyperplane(std::span<const int> corners, IntegerHyperplane& result);
  void narrow_hyperplane(std::span<const int> corners, IntegerHyperplane& result);

  int dimension_;
  std::array<int, kMaxDimension> scales_ = {};
  std::vector<IntegerVector> points_;
  /// The same points where all coordinates are below 2^60: then k × k determinants fit in k digits,
  /// and need no memory management. Else empty.
  std::vector<NarrowPoint> narrow_points_;
  std::vector<SignedDigits> narrow_minors_;  // of the rows so far, by set of columns
  std::vector<Integer> minors_;
  IntegerVector row_;
  Integer value_;
};

/// Rows of integers in echelon form, to find the rank of a set of vectors one by one [Bareiss
/// 1968].
class IntegerEchelon {
 public:
  /// `scales` are those of IntegerPoints: the pivot of a row is its largest entry after scaling.
  IntegerEchelon(int dimension, std::array<int, kMaxDimension> scales)
      : dimension_(dimension), scales_(scales) {}

  /// Adds `row` if it is linearly independent of the rows before; returns whether it is.
  bool add(const IntegerVector& row);

  int rank() const { return base::as_index<int>(rows_.size()); }
  /// A column per independent row, such that the rows restricted to these columns are independent.
  const std::vector<int>& columns() const { return columns_; }

 private:
  int dimension_;
  std::array<int, kMaxDimension> scales_;
  std::vector<IntegerVector> rows_;
  std::vector<int> columns_;
};

}  // namespace graspfit::geometry::internal
