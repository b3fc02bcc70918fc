#include "hull/exact_hyperplane.hpp"

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
    std::uint8_t next = 0;
    for (int size = 0; size <= dimension; ++size) {
      first[size] = next;
      for (unsigned set = 0; set < 1U << dimension; ++set) {
        if (std::popcount(set) == size) sets[next++] = static_cast<std::uint8_t>(set);
      }
    }
    first[dimension + 1] = next;
  }
  return all;
}();

/// Differences are below 2^61: by Hadamard's inequality a determinant of k rows is at most
/// (sqrt(k) 2^61)^k, below 2^(64 k − 1) for k up to 6.
constexpr std::size_t kNarrowBits = 60;

/// A difference of two narrow points.
struct Row {
  using Point = std::array<std::int64_t, kMaxDimension>;

  Row() = default;
  Row(const Point& end, const Point& start, int dimension) {
    for (int j = 0; j < dimension; ++j) {
      const std::int64_t x = end[j] - start[j];
      is_negative[j] = x < 0;
      magnitudes[j] = static_cast<std::uint64_t>(x < 0 ? -x : x);
    }
  }

  std::array<std::uint64_t, kMaxDimension> magnitudes;
  std::array<unsigned, kMaxDimension> is_negative;
};

/// sum += number · factor. The last of several digits of `number` only extends its sign: it is 0 or
/// minus one, so that its product needs no multiplication.
template <int NumDigits>
void add_product(const Digits& number, std::uint64_t factor, std::uint64_t* sum) {
  if constexpr (NumDigits == 1) {
    sum[0] += number[0] * factor;
  } else {
    __extension__ using Wide = unsigned __int128;
    std::uint64_t carry = 0;
    for (int i = 0; i < NumDigits - 1; ++i) {
      const Wide term = static_cast<Wide>(number[i]) * factor + sum[i] + carry;
      sum[i] = static_cast<std::uint64_t>(term);
      carry = static_cast<std::uint64_t>(term >> 64);
    }
    sum[NumDigits - 1] += carry - (number[NumDigits - 1] & factor);
  }
}

/// One minor of as many rows as `Set` has columns, by Laplace expansion along the last of them:
/// k × k minors with k digits and one to extend the sign.
template <unsigned Set, std::size_t... J>
void expand_minor(const Row& row, SignedDigits* minors, std::index_sequence<J...>) {
  constexpr int kSize = std::popcount(Set);
  std::array<std::uint64_t, kSize + 1> sum = {};
  const auto add = [&]<std::size_t j>(std::integral_constant<std::size_t, j>) {
    if constexpr ((Set >> j & 1U) != 0) {
      constexpr unsigned kSign = kSize - 1 + std::popcount(Set & ((1U << j) - 1U));
      const SignedDigits& smaller = minors[Set ^ (1U << j)];
      add_product<kSize>(smaller[(kSign ^ row.is_negative[j]) & 1U], row.magnitudes[j], sum.data());
    }
  };
  (add(std::integral_constant<std::size_t, J>{}), ...);
  sum[kSize] = sum[kSize - 1] >> 63 != 0 ? ~std::uint64_t{0} : 0;
  auto& [positive, negative] = minors[Set];
  std::uint64_t carry = 1;
  for (int i = 0; i <= kSize; ++i) {
    positive[i] = sum[i];
    negative[i] = ~sum[i] + carry;
    carry &= static_cast<std::uint64_t>(negative[i] == 0);
  }
}

/// All minors of the first |S| rows in the columns S, for 0 < S < 2^d − 1 in order, so that smaller
/// minors are computed first; the loop is unrolled.
template <int Dimension, std::size_t... S>
void expand_minors(const std::array<Row, kMaxDimension - 1>& rows, SignedDigits* minors,
                   std::index_sequence<S...>) {
  (expand_minor<S + 1>(rows[std::popcount(S + 1) - 1], minors,
                       std::make_index_sequence<Dimension>{}),
   ...);
}

template <int Dimension>
void expand_minors(const std::array<Row, kMaxDimension - 1>& rows, SignedDigits* minors) {
  expand_minors<Dimension>(rows, minors,
                           std::make_index_sequence<(std::size_t{1} << Dimension) - 2>{});
}

template <int Dimension>
Digits product(const std::array<SignedDigits, kMaxDimension>& normal, const Row& row) {
  Digits sum = {};
  for (int j = 0; j < Dimension; ++j) {
    add_product<Dimension>(normal[j][row.is_negative[j]], row.magnitudes[j], sum.data());
  }
  return sum;
}

/// normal · row, in as many digits as there are axes: a determinant of that many rows.
Digits product(const std::array<SignedDigits, kMaxDimension>& normal, const Row& row,
               int dimension) {
  switch (dimension) {
    case 1:
      return product<1>(normal, row);
    case 2:
      return product<2>(normal, row);
    case 3:
      return product<3>(normal, row);
    case 4:
      return product<4>(normal, row);
    case 5:
      return product<5>(normal, row);
    default:
      return product<6>(normal, row);
  }
}

bool is_negative_number(const Digits& number, int num_digits) {
  return number[num_digits - 1] >> 63 != 0;
}

BinaryParts parts_of(Digits number, int num_digits) {
  const bool is_negative = is_negative_number(number, num_digits);
  std::uint64_t carry = 1;
  for (int i = 0; i < num_digits && is_negative; ++i) {
    number[i] = ~number[i] + carry;
    carry &= static_cast<std::uint64_t>(number[i] == 0);
  }
  int top = num_digits - 1;
  while (top > 0 && number[top] == 0) --top;
  if (number[top] == 0) return {0.0, 0};
  const int num_zeros = std::countl_zero(number[top]);
  std::uint64_t leading = number[top] << num_zeros;
  if (num_zeros > 0 && top > 0) leading |= number[top - 1] >> (64 - num_zeros);
  const double mantissa = std::ldexp(static_cast<double>(leading >> 11), -53);
  return {is_negative ? -mantissa : mantissa, 64L * (top + 1) - num_zeros};
}

}  // namespace

IntegerPoints::IntegerPoints(const Eigen::Ref<const Eigen::MatrixXd>& points)
    : dimension_(static_cast<int>(points.rows())),
      points_(points.cols()),
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

void IntegerPoints::find_narrow_minors(std::span<const int> corners) {
  std::array<Row, kMaxDimension - 1> rows;
  for (int k = 1; k < dimension_; ++k) {
    rows[k - 1] = Row(narrow_points_[corners[k]], narrow_points_[corners[0]], dimension_);
  }
  SignedDigits* const minors = narrow_minors_.data();
  minors[0] = {Digits{1}, Digits{~std::uint64_t{0}}};
  switch (dimension_) {
    case 1:
      return;
    case 2:
      return expand_minors<2>(rows, minors);
    case 3:
      return expand_minors<3>(rows, minors);
    case 4:
      return expand_minors<4>(rows, minors);
    case 5:
      return expand_minors<5>(rows, minors);
    default:
      return expand_minors<6>(rows, minors);
  }
}

void IntegerPoints::wide_hyperplane(std::span<const int> corners, IntegerHyperplane& result) {
  find_minors(corners);
  const unsigned full = (1U << dimension_) - 1U;
  mpz_ptr offset = result.offset.mpz();
  mpz_set_ui(offset, 0);
  for (int j = 0; j < dimension_; ++j) {
    mpz_ptr coefficient = result.normal[j].mpz();
    mpz_set(coefficient, minors_[full ^ (1U << j)].mpz());
    if ((dimension_ - 1 + j) % 2 != 0) mpz_neg(coefficient, coefficient);
    mpz_addmul(offset, coefficient, points_[corners[0]][j].mpz());
    result.normal_parts[j] = result.normal[j].parts();
  }
  result.offset_parts = result.offset.parts();
}

void IntegerPoints::narrow_hyperplane(std::span<const int> corners, IntegerHyperplane& result) {
  find_narrow_minors(corners);
  const unsigned full = (1U << dimension_) - 1U;
  for (int j = 0; j < dimension_; ++j) {
    const SignedDigits& minor = narrow_minors_[full ^ (1U << j)];
    const unsigned sign = static_cast<unsigned>(dimension_ - 1 + j) & 1U;
    result.digits[j] = {minor[sign], minor[1 - sign]};
    result.normal_parts[j] = parts_of(result.digits[j][0], dimension_);
  }
  result.base = corners[0];
  const Row base(narrow_points_[result.base], Row::Point{}, dimension_);
  result.offset_parts = parts_of(product(result.digits, base, dimension_), dimension_);
}

void IntegerPoints::hyperplane(std::span<const int> corners, IntegerHyperplane& result) {
  assert(std::ssize(corners) == dimension_);
  if (is_narrow()) {
    narrow_hyperplane(corners, result);
  } else {
    wide_hyperplane(corners, result);
  }
}

BinaryParts IntegerPoints::evaluate(const IntegerHyperplane& plane, int index) {
  if (is_narrow()) {
    const Row row(narrow_points_[index], narrow_points_[plane.base], dimension_);
    return parts_of(product(plane.digits, row, dimension_), dimension_);
  }
  mpz_ptr value = value_.mpz();
  mpz_neg(value, plane.offset.mpz());
  for (int j = 0; j < dimension_; ++j) {
    mpz_addmul(value, plane.normal[j].mpz(), points_[index][j].mpz());
  }
  return value_.parts();
}

IntegerVector IntegerPoints::normal(const IntegerHyperplane& plane) const {
  if (!is_narrow()) return plane.normal;
  IntegerVector result;
  for (int j = 0; j < dimension_; ++j) {
    const bool is_negative = is_negative_number(plane.digits[j][0], dimension_);
    mpz_ptr coefficient = result[j].mpz();
    mpz_import(coefficient, static_cast<std::size_t>(dimension_), -1, sizeof(std::uint64_t), 0, 0,
               plane.digits[j][is_negative ? 1 : 0].data());
    if (is_negative) mpz_neg(coefficient, coefficient);
  }
  return result;
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
