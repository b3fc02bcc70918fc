#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/rational_distance.hpp"
#include "graspfit/base/random.hpp"
#include "query/triangle_pair.hpp"
#include "support/catch.hpp"

namespace test_triangle_pair {

using namespace graspfit::base;
using namespace graspfit::geometry;
using namespace graspfit::testing;
using Eigen::Vector3d;
using internal::Corners;

namespace {

Vector3d drawn(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

/// Corners of any triangle, of a sliver, or of one far from the origin.
Corners drawn_triangle(Random& random, int kind) {
  const Vector3d shift = kind == 2 ? Vector3d(100.0, -50.0, 70.0) : Vector3d::Zero();
  Corners corners = {drawn(random, 1.0), drawn(random, 1.0), drawn(random, 1.0)};
  if (kind == 1) {
    corners[2] = corners[0] + random.uniform() * (corners[1] - corners[0]) + drawn(random, 1e-9);
  }
  for (Vector3d& corner : corners) corner += shift;
  return corners;
}

}  // namespace

TEST_CASE("Nearest points of two segments are as near as the segments, at any angle",
          "[geometry][triangle_pair]") {
  Random random(3);
  double worst = 0.0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Vector3d p0 = drawn(random, 1.0);
    const Vector3d p1 = drawn(random, 1.0);
    // Parallel, nearly so, and any.
    const double off = trial % 3 == 0 ? 0.0 : std::pow(10.0, random.uniform(-12.0, 0.0));
    const Vector3d q0 = drawn(random, trial % 2 == 0 ? 1.0 : 1e-3) + p0;
    const Vector3d q1 = q0 + random.uniform(-2.0, 2.0) * (p1 - p0) + off * drawn(random, 1.0);
    const auto [p, q] = internal::closest_on_segments(p0, p1, q0, q1);
    const double expected = rounded_root(
        squared_distance_of_segments(exactly(p0), exactly(p1), exactly(q0), exactly(q1)));
    const double size = std::max({(p1 - p0).norm(), (q1 - q0).norm(), (q0 - p0).norm()});
    worst = std::max(worst, std::abs((p - q).norm() - expected) / size);
    // Both lie on their segments.
    const auto beside = [](const Vector3d& point, const Vector3d& a, const Vector3d& b) {
      return rounded_root(squared_distance_to_segment(exactly(point), exactly(a), exactly(b)));
    };
    CHECK(beside(p, p0, p1) < 1e-15 * (1.0 + size));
    CHECK(beside(q, q0, q1) < 1e-15 * (3.0 + size));
  }
  CHECK(worst < 400.0 * 0x1p-53 * 3.0);
}

TEST_CASE("Heights over a triangle's plane pass nothing over that is within a bound",
          "[geometry][triangle_pair]") {
  Random random(4);
  int num_beyond = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const int kind = trial % 3;
    const Corners plane = drawn_triangle(random, kind);
    Corners points = drawn_triangle(random, kind == 1 ? 0 : kind);
    if (trial % 2 == 0) {  // near the plane, where rounding decides
      for (Vector3d& point : points) {
        point = plane[0] + random.uniform(-1.0, 1.0) * (plane[1] - plane[0]) +
                random.uniform(-1.0, 1.0) * (plane[2] - plane[0]) + drawn(random, 1e-13);
      }
    }
    const internal::Heights heights(plane, points);
    const auto a = exactly(plane);
    const auto b = exactly(points);
    const RationalPoint normal = cross(minus(a[1], a[0]), minus(a[2], a[0]));
    const Rational squared_normal = squared_length(normal);
    if (squared_normal == 0) continue;
    std::array<Rational, 3> exact;
    for (std::size_t i = 0; i < 3; ++i) exact[i] = dot(minus(b[i], a[0]), normal);
    for (const double bound : {1e-15, 1e-13, 1e-9, 1e-3, 0.3}) {
      const Rational limit = Rational(bound) * Rational(bound) * squared_normal;
      const auto is_within = [&](std::size_t i) { return exact[i] * exact[i] <= limit; };
      const auto crosses = [&](std::size_t i, std::size_t j) {
        return (exact[i] <= 0) != (exact[j] <= 0);
      };
      bool is_any_within = false;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t next = (i + 1) % 3;
        if (is_within(i)) CHECK(heights.is_corner_near(i, bound * bound));
        if (is_within(i) || is_within(next) || crosses(i, next)) {
          CHECK(heights.is_edge_near(i, bound * bound));
          is_any_within = true;
        }
      }
      if (is_any_within) CHECK_FALSE(heights.are_beyond(bound * bound));
      num_beyond += heights.are_beyond(bound * bound) ? 1 : 0;
    }
  }
  CHECK(num_beyond > 1000);
}

TEST_CASE("An edge pierces a triangle where it passes through it", "[geometry][triangle_pair]") {
  const Corners floor = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)};
  const Corners upright = {Vector3d(0.25, 0.25, -1), Vector3d(0.25, 0.25, 1), Vector3d(5, 5, 1)};
  const auto point = internal::piercing(upright, floor);
  REQUIRE(point);
  CHECK((*point - Vector3d(0.25, 0.25, 0)).norm() < 1e-15);
  // The same pair the other way round: no edge of the floor passes through the upright one.
  CHECK_FALSE(
      internal::piercing(floor, Corners{Vector3d(3, 3, -1), Vector3d(3, 3, 1), Vector3d(5, 5, 1)}));
  Random random(5);
  int num_piercing = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Corners a = drawn_triangle(random, 0);
    const Corners b = drawn_triangle(random, 0);
    bool expected = false;
    for (std::size_t i = 0; i < 3; ++i) {
      expected = expected || passes_through(exactly(a[i]), exactly(a[(i + 1) % 3]), exactly(b));
    }
    const auto found = internal::piercing(a, b);
    CHECK(found.has_value() == expected);
    num_piercing += expected ? 1 : 0;
    if (!found) continue;
    CHECK(rounded_root(squared_distance_to_triangle(exactly(*found), exactly(b))) < 1e-13);
  }
  CHECK(num_piercing > 100);
}

}  // namespace test_triangle_pair
