#include "internal/exact_hyperplane.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>

namespace graspfit::geometry::internal {
namespace {

/// A double as mantissa · 2^exponent with an odd integer mantissa; {0, 0} for zero.
std::pair<std::int64_t, int> odd_parts(double value) {
  if (value == 0.0) return {0, 0};
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  auto mantissa = static_cast<std::int64_t>(std::ldexp(fraction, 53));
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(std::abs(mantissa)));
  mantissa /= std::int64_t{1} << zeros;
  return {mantissa, exponent - 53 + zeros};
}

/// All sets of columns, as bit masks in order of their size.
struct ColumnSets {
  std::array<std::uint8_t, std::size_t{1} << kMaxDimension> sets = {};
  std::array<std::uint8_t, kMaxDimension + 2> first = {};  // where the sets of a size begin

  std::span<const std::uint8_t> of_size(int size) const {
    return {sets.data() + first[size], static_cast<std::size_t>(first[size + 1] - first[size])};
  }
};

/// By the number of columns that there are.
constexpr auto kColumnSets = [] {
  std::array<ColumnSets, kMaxDimension + 1> all = {};
  for (int dimension = 1; dimension <= kMaxDimension; ++dimension) {
    auto& [sets, first] = all[dimension];
    std::uint8_t place = 0;
    for (int size = 0; size <= dimension; ++size) {
      first[size] = place;
      for (unsigned set = 0; set < 1U << dimension; ++set) {
        if (std::popcount(set) == size) sets[place++] = static_cast<std::uint8_t>(set);
      }
    }
    first[dimension + 1] = place;
  }
  return all;
}();

constexpr std::size_t kNarrowBits = 60;

}  // namespace

IntegerPoints::IntegerPoints(const Eigen::Ref<const Eigen::MatrixXd>& points)
    : dimension_(static_cast<int>(points.rows())),
      points_(static_cast<std::size_t>(points.cols())),
      minors_(std::size_t{1} << points.rows()) {
  static_assert(std::numeric_limits<long>::digits >= 60, "GMP takes and gives 64-bit numbers");
  std::size_t num_bits = 0;
  for (int j = 0; j < dimension_; ++j) {
    int lowest = std::numeric_limits<int>::max();
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      if (points(j, i) != 0.0) lowest = std::min(lowest, odd_parts(points(j, i)).second);
    }
    if (lowest == std::numeric_limits<int>::max()) lowest = 0;
    scales_[j] = -lowest;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const auto [mantissa, exponent] = odd_parts(points(j, i));
      mpz_ptr z = points_[i][j].mpz();
      mpz_set_si(z, mantissa);
      if (mantissa != 0) mpz_mul_2exp(z, z, static_cast<mp_bitcnt_t>(exponent - lowest));
    }
    const Integer origin = points_[0][j];
    for (IntegerVector& point : points_) {
      mpz_sub(point[j].mpz(), point[j].mpz(), origin.mpz());
      num_bits = std::max(num_bits, mpz_sizeinbase(point[j].mpz(), 2));
    }
  }
  if (num_bits > kNarrowBits) return;
  narrow_points_.resize(points_.size());
  narrow_minors_.resize(minors_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    for (int j = 0; j < dimension_; ++j) narrow_points_[i][j] = mpz_get_si(points_[i][j].mpz());
  }
}

// Minors of the first rows (differences of corners) in all sets of as many columns, by Laplace
// expansion along the last of the rows.
void IntegerPoints::find_minors(std::span<const int> corners) {
  const IntegerVector& base = points_[corners[0]];
  mpz_set_ui(minors_[0].mpz(), 1);
  for (int size = 1; size < dimension_; ++size) {
    for (int j = 0; j < dimension_; ++j) {
      mpz_sub(row_[j].mpz(), points_[corners[size]][j].mpz(), base[j].mpz());
    }
    for (const unsigned set : kColumnSets[dimension_].of_size(size)) {
      mpz_ptr minor = minors_[set].mpz();
      mpz_set_ui(minor, 0);
      int sign = size - 1;  // even: plus
      for (unsigned rest = set; rest != 0; rest &= rest - 1, ++sign) {
        const int j = std::countr_zero(rest);
        mpz_srcptr smaller = minors_[set ^ (1U << j)].mpz();
        if (sign % 2 == 0) {
          mpz_addmul(minor, row_[j].mpz(), smaller);
        } else {
          mpz_submul(minor, row_[j].mpz(), smaller);
        }
      }
    }
  }
}

/// The same for one number of rows, on digits: k × k minors with k digits and one to extend the
/// sign. Of each minor its negative is at hand, so that only magnitudes are multiplied.
template <int Size>
void IntegerPoints::expand_narrow_minors(std::span<const int> corners) {
  __extension__ using Wide = unsigned __int128;
  std::array<std::uint64_t, kMaxDimension> magnitudes;
  std::array<unsigned, kMaxDimension> is_negative;
  for (int j = 0; j < dimension_; ++j) {
    const std::int64_t x = narrow_points_[corners[Size]][j] - narrow_points_[corners[0]][j];
    is_negative[j] = x < 0;
    magnitudes[j] = static_cast<std::uint64_t>(x < 0 ? -x : x);
  }
  for (const unsigned set : kColumnSets[dimension_].of_size(Size)) {
    std::array<std::uint64_t, Size + 1> sum = {};
    unsigned sign = Size - 1;
    for (unsigned rest = set; rest != 0; rest &= rest - 1, ++sign) {
      const int j = std::countr_zero(rest);
      const Digits& smaller = narrow_minors_[set ^ (1U << j)][(sign ^ is_negative[j]) & 1U];
      std::uint64_t carry = 0;
      for (int i = 0; i < Size; ++i) {
        const Wide term = static_cast<Wide>(smaller[i]) * magnitudes[j] + sum[i] + carry;
        sum[i] = static_cast<std::uint64_t>(term);
        carry = static_cast<std::uint64_t>(term >> 64);
      }
    }
    sum[Size] = sum[Size - 1] >> 63 != 0 ? ~std::uint64_t{0} : 0;
    auto& [positive, negative] = narrow_minors_[set];
    std::uint64_t carry = 1;
    for (int i = 0; i <= Size; ++i) {
      positive[i] = sum[i];
      negative[i] = ~sum[i] + carry;
      carry &= static_cast<std::uint64_t>(negative[i] == 0);
    }
  }
}

void IntegerPoints::find_narrow_minors(std::span<const int> corners) {
  narrow_minors_[0] = {Digits{1}, Digits{~std::uint64_t{0}}};
  if (dimension_ > 1) expand_narrow_minors<1>(corners);
  if (dimension_ > 2) expand_narrow_minors<2>(corners);
  if (dimension_ > 3) expand_narrow_minors<3>(corners);
  if (dimension_ > 4) expand_narrow_minors<4>(corners);
  if (dimension_ > 5) expand_narrow_minors<5>(corners);
  if (dimension_ == 1) mpz_set_ui(minors_[0].mpz(), 1);
  const unsigned full = (1U << dimension_) - 1U;
  const auto size = static_cast<std::size_t>(dimension_ - 1);
  for (int j = 0; j < dimension_ && size > 0; ++j) {
    const unsigned set = full ^ (1U << j);
    const bool is_negative = narrow_minors_[set][0][size] != 0;
    const Digits& digits = narrow_minors_[set][is_negative ? 1 : 0];
    mpz_ptr minor = minors_[set].mpz();
    mpz_import(minor, size, -1, sizeof(std::uint64_t), 0, 0, digits.data());
    if (is_negative) mpz_neg(minor, minor);
  }
}

void IntegerPoints::hyperplane(std::span<const int> corners, IntegerHyperplane& result) {
  assert(static_cast<int>(corners.size()) == dimension_);
  if (narrow_points_.empty()) {
    find_minors(corners);
  } else {
    find_narrow_minors(corners);
  }
  const unsigned full = (1U << dimension_) - 1U;
  mpz_ptr offset = result.offset.mpz();
  mpz_set_ui(offset, 0);
  for (int j = 0; j < dimension_; ++j) {
    mpz_ptr coefficient = result.normal[j].mpz();
    mpz_set(coefficient, minors_[full ^ (1U << j)].mpz());
    if ((dimension_ - 1 + j) % 2 != 0) mpz_neg(coefficient, coefficient);
    mpz_addmul(offset, coefficient, points_[corners[0]][j].mpz());
  }
}

const Integer& IntegerPoints::evaluate(const IntegerHyperplane& plane, int index) {
  mpz_ptr value = value_.mpz();
  mpz_neg(value, plane.offset.mpz());
  for (int j = 0; j < dimension_; ++j) {
    mpz_addmul(value, plane.normal[j].mpz(), points_[index][j].mpz());
  }
  return value_;
}

bool IntegerEchelon::add(const IntegerVector& new_row) {
  if (rank() == dimension_) return false;
  IntegerVector row = new_row;
  Integer previous_pivot;
  mpz_set_ui(previous_pivot.mpz(), 1);
  for (int k = 0; k < rank(); ++k) {
    const IntegerVector& basis = rows_[k];
    const Integer pivot = basis[columns_[k]];
    const Integer factor = row[columns_[k]];
    for (int j = 0; j < dimension_; ++j) {
      mpz_ptr z = row[j].mpz();
      mpz_mul(z, z, pivot.mpz());
      mpz_submul(z, factor.mpz(), basis[j].mpz());
      mpz_divexact(z, z, previous_pivot.mpz());  // entries stay minors of the input
    }
    previous_pivot = pivot;
  }
  int column = -1;
  std::pair<long, double> largest = {std::numeric_limits<long>::min(), 0.0};
  for (int j = 0; j < dimension_; ++j) {
    if (row[j].sign() == 0) continue;
    const auto [mantissa, exponent] = row[j].parts();
    if (const std::pair size{exponent - scales_[j], std::abs(mantissa)}; size > largest) {
      largest = size;
      column = j;
    }
  }
  if (column < 0) return false;
  rows_.push_back(std::move(row));
  columns_.push_back(column);
  return true;
}

}  // namespace graspfit::geometry::internal
