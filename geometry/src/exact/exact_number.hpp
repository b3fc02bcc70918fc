#pragma once

#include <CGAL/Gmpq.h>
#include <CGAL/Interval_nt.h>

#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

/// \file
/// Signs of expressions for which CGAL's kernels have no predicate, as CGAL decides its own: by
/// interval arithmetic, and in rationals where intervals do not tell.

namespace graspfit::geometry::internal {

/// CGAL's number that any double converts to without loss.
using Rational = CGAL::Gmpq;

/// CGAL's interval of doubles, for use while `CGAL::Protect_FPU_rounding` is in force.
using Interval = CGAL::Interval_nt_advanced;

template <typename Number>
int sign_of(const Number& value) {
  return static_cast<int>(CGAL::sign(value));
}

/// Sign of `evaluate(Interval())`, or nothing if the interval holds zero and other numbers.
/// `evaluate` maps a number of any type, whose value is not used, to the expression's value
/// computed in that type. Certain also where numbers overflow and underflow. Numbers round upward
/// while it is at work: it may be inlined, so callers compute nothing in doubles beside it.
template <typename Expression>
std::optional<int> sign_by_intervals(const Expression& evaluate) {
  const CGAL::Protect_FPU_rounding<true> upward;
  const CGAL::Uncertain<CGAL::Sign> sign = CGAL::sign(evaluate(Interval()));
  if (!CGAL::is_certain(sign)) return std::nullopt;
  return static_cast<int>(CGAL::get_certain(sign));
}

/// Sign of an expression as `sign_by_intervals` takes it, in `Exact` where intervals do not tell.
template <typename Exact, typename Expression>
int sign_of_expression(const Expression& evaluate) {
  const std::optional<int> sign = sign_by_intervals(evaluate);
  return sign ? *sign : sign_of(evaluate(Exact()));
}

/// The interval of an expression. Not inlined, so that nothing else is computed while numbers round
/// upward.
template <typename Expression>
[[gnu::noinline]] Interval interval_of(const Expression& evaluate) {
  const CGAL::Protect_FPU_rounding<true> upward;
  return evaluate(Interval());
}

/// Value of an expression as `sign_by_intervals` takes it, or nothing if intervals leave it open by
/// more than `share` of it.
template <typename Expression>
std::optional<double> value_by_intervals(const Expression& evaluate, double share) {
  const Interval value = interval_of(evaluate);
  const double middle = 0.5 * value.inf() + 0.5 * value.sup();
  if (value.inf() != value.sup() && !(value.sup() - value.inf() <= share * std::abs(middle))) {
    return std::nullopt;
  }
  return middle;
}

/// The double nearest to an exact number; of two equally near ones the even one, as IEEE 754
/// rounds, so that from 2^1024 − 2^970 on it is infinity.
/// (`CGAL::to_double` of a Gmpq cuts digits off.)
template <typename Exact>
double nearest_double(const Exact& value) {
  const auto [low, high] = CGAL::to_interval(value);
  constexpr double kMost = std::numeric_limits<double>::max();
  if (!std::isfinite(low) || !std::isfinite(high)) {
    // Half a unit in the last place beyond the largest double.
    const Exact limit = Exact(kMost) + Exact(0x1p970);
    if (std::isfinite(low)) return value < limit ? kMost : high;
    return value > -limit ? -kMost : low;
  }
  assert(high <= std::nextafter(low, HUGE_VAL));  // They are neighbors, or the number itself.
  if (low == high) return low;
  const int side = sign_of(Exact(value + value - Exact(low) - Exact(high)));
  if (side != 0) return side > 0 ? high : low;
  return (std::bit_cast<std::uint64_t>(low) & 1) == 0 ? low : high;
}

}  // namespace graspfit::geometry::internal
