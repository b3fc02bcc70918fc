#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

#include "exact/exact_number.hpp"
#include "exact/predicates.hpp"
#include "graspfit/base/random.hpp"
#include "support/catch.hpp"

namespace test_predicates {

using Eigen::Vector3d;
using graspfit::base::Random;
using namespace graspfit::geometry::internal;

namespace {

Rational difference(double a, double b) { return Rational(a) - Rational(b); }

int rational_cross(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d,
                   int u, int v) {
  return sign_of(Rational(difference(b[u], a[u]) * difference(d[v], c[v]) -
                          difference(b[v], a[v]) * difference(d[u], c[u])));
}

int rational_orientation(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                         const Vector3d& d) {
  Rational sum(0);
  for (int i = 0; i < 3; ++i) {
    const int u = (i + 1) % 3;
    const int v = (i + 2) % 3;
    sum += difference(d[i], a[i]) * (difference(b[u], a[u]) * difference(c[v], a[v]) -
                                     difference(b[v], a[v]) * difference(c[u], a[u]));
  }
  return sign_of(sum);
}

/// Points that are hard in turn: of a coarse lattice, where a third of all signs are zero; the same
/// moved by single ulps; with coordinates of wildly different powers; subnormal; huge.
Vector3d drawn_point(Random& random, int kind) {
  Vector3d point;
  for (double& x : point) {
    x = static_cast<double>(random.index(5)) - 2.0;
    if (kind == 1 && random.index(2) == 0) x = std::nextafter(x, 10.0);
    if (kind == 2) x = std::ldexp(x, static_cast<int>(random.index(1800)) - 900);
    if (kind == 3) x *= std::numeric_limits<double>::denorm_min();
    if (kind == 4) x *= 0x1p1021;
  }
  return point;
}

}  // namespace

TEST_CASE("An orientation whose terms leave the range of doubles has the right sign",
          "[geometry][predicates]") {
  // det = (2^600 2^-550 − 2^-100 2^-100) 2^-550 > 0, of which products in doubles keep nothing.
  const Vector3d a = Vector3d::Zero();
  const Vector3d b(0x1p-100, 0.0, 0x1p600);
  const Vector3d c(0x1p-550, 0.0, 0x1p-100);
  const Vector3d d(0.0, 0x1p-550, 0.0);
  CHECK(orientation(a, b, c, d) == 1);
  CHECK(orientation(a, c, b, d) == -1);
}

TEST_CASE("Signs are those of rational arithmetic", "[geometry][predicates]") {
  Random random(20261126);
  int num_zero = 0;
  for (int round = 0; round < 5000; ++round) {
    const int kind = round % 5;
    const Vector3d a = drawn_point(random, kind);
    const Vector3d b = drawn_point(random, kind);
    const Vector3d c = drawn_point(random, kind);
    const Vector3d d = drawn_point(random, kind);
    INFO("round " << round);
    const int side = rational_orientation(a, b, c, d);
    num_zero += side == 0 ? 1 : 0;
    REQUIRE(orientation(a, b, c, d) == side);
    bool is_on_line = true;
    for (int u = 0; u < 3; ++u) {
      const int v = (u + 1) % 3;
      const int turn = rational_cross(a, b, a, c, u, v);
      is_on_line = is_on_line && turn == 0;
      REQUIRE(orientation_2d(a, b, c, u, v) == turn);
      REQUIRE(cross_2d(a, b, c, d, u, v) == rational_cross(a, b, c, d, u, v));
    }
    REQUIRE(are_collinear(a, b, c) == is_on_line);
    REQUIRE(is_beside({a, b, c}, {d, d, d}) == (side != 0));
    REQUIRE_FALSE(is_beside({a, b, c}, {d, d, a}));
  }
  CHECK(num_zero > 300);
}

TEST_CASE("Expressions that overflow, underflow or cancel get their exact sign",
          "[geometry][predicates]") {
  const auto sign_of_cube_difference = [](double x, double y) {
    const auto expression = [&](const auto& number) {
      using Number = std::decay_t<decltype(number)>;
      const Number p(x);
      const Number q(y);
      return Number(p * p * p - q * q * q);
    };
    return std::pair(sign_by_intervals(expression), sign_of_expression<Rational>(expression));
  };
  const std::optional<int> unknown;
  CHECK(sign_of_cube_difference(2.0, 1.0) == std::pair(std::optional(1), 1));
  CHECK(sign_of_cube_difference(1.0, 1.0) == std::pair(std::optional(0), 0));
  CHECK(sign_of_cube_difference(0.1, 0.1) == std::pair(unknown, 0));
  CHECK(sign_of_cube_difference(0.1, std::nextafter(0.1, 1.0)) == std::pair(unknown, -1));
  CHECK(sign_of_cube_difference(0x1p500, 0x1p501) == std::pair(unknown, -1));
  CHECK(sign_of_cube_difference(0x1p-500, 0x1p-501) == std::pair(unknown, 1));
}

TEST_CASE("The nearest double of a quotient is what a division rounds to",
          "[geometry][predicates]") {
  Random random(5);
  for (int round = 0; round < 2000; ++round) {
    const double p = std::ldexp(random.uniform(-1.0, 1.0), static_cast<int>(random.index(800)));
    const double q = std::ldexp(random.uniform(0.1, 1.0), static_cast<int>(random.index(800)));
    REQUIRE(nearest_double(Rational(p) / Rational(q)) == p / q);
  }
  // Halfway between two doubles the even one counts.
  const Rational ulp(0x1p-52);
  CHECK(nearest_double(Rational(1.0) + ulp / Rational(2)) == 1.0);
  CHECK(nearest_double(Rational(-1.0) - ulp * Rational(3) / Rational(2)) == -1.0 - 0x1p-51);
  CHECK(nearest_double(Rational(0)) == 0.0);
  const double least = std::numeric_limits<double>::denorm_min();
  CHECK(nearest_double(Rational(least) * Rational(3) / Rational(4)) == least);
  CHECK(nearest_double(Rational(least) / Rational(-4)) == 0.0);
}

}  // namespace test_predicates
