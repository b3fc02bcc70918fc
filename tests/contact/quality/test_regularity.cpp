#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "contact/ball_directions.hpp"
#include "graspfit/contact/contact_quality.hpp"
#include "support/catch.hpp"

namespace test_regularity {

using namespace graspfit::contact;
using Eigen::Vector3d;
using graspfit::testing::bipyramid;
using graspfit::testing::equator;
using graspfit::testing::octahedron;
using graspfit::testing::radians;
using graspfit::testing::tetrahedron;

namespace {

constexpr double kPi = std::numbers::pi;

// Sums of a few products of numbers near one are off by at most a hundred roundings.
constexpr double kRounding = 1e-13;

}  // namespace

TEST_CASE("Regular polygons and polyhedra have regularity 1", "[contact][regularity]") {
  std::vector<Vector3d> points;
  SECTION("equilateral triangle") { points = equator(120, 120); }
  SECTION("square") { points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}; }
  SECTION("pentagon") {
    for (int i = 0; i < 5; ++i) {
      points.emplace_back(std::cos(2 * kPi * i / 5), std::sin(2 * kPi * i / 5), 0.3);
    }
  }
  SECTION("tetrahedron") { points = tetrahedron(); }
  SECTION("octahedron") { points = octahedron(); }
  SECTION("cube, whose faces are two triangles each") {
    for (int i = 0; i < 8; ++i) points.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
  }
  SECTION("icosahedron") {
    const double g = std::numbers::phi;
    for (const double s : {-1.0, 1.0}) {
      for (const double t : {-g, g}) {
        points.emplace_back(0, s, t);
        points.emplace_back(s, t, 0);
        points.emplace_back(t, 0, s);
      }
    }
  }
  for (const Regularity definition :
       {Regularity::Combined, Regularity::AngleOnly, Regularity::EdgeOnly}) {
    CHECK(regularity(points, definition) == Approx(1.0).epsilon(kRounding));
    // After a turn the triangles are coplanar only up to rounding.
    std::vector<Vector3d> turned;
    const Eigen::AngleAxisd rotation(0.7, Vector3d(0.3, -1, 0.4).normalized());
    for (const Vector3d& point : points) turned.push_back(rotation * point);
    CHECK(regularity(turned, definition) == Approx(1.0).epsilon(1e-11));
  }
}

TEST_CASE("Irregular hulls have the regularity of their angles and edges",
          "[contact][regularity]") {
  SECTION("isosceles triangle with an apex of 20 degrees") {
    // The angles are 20, 80, 80, so that Q = (40 + 20 + 20)/240 = 1/3. The edges have base/leg = 2
    // sin 10 = 0.3473.
    const std::vector<Vector3d> points = {
        {0, 0, 0}, {1, 0, 0}, {std::cos(radians(20)), std::sin(radians(20)), 0}};
    CHECK(regularity(points, Regularity::AngleOnly) == Approx(2.0 / 3.0).epsilon(kRounding));
    CHECK(regularity(points, Regularity::EdgeOnly) ==
          Approx(2 * std::sin(radians(10))).epsilon(kRounding));
    CHECK(regularity(points, Regularity::AngleOnly) == Approx(0.667).margin(0.0005));
    CHECK(regularity(points, Regularity::EdgeOnly) == Approx(0.347).margin(0.0005));
    CHECK(regularity(points, Regularity::Combined) == Approx(0.48).margin(0.005));
  }
  SECTION("triangular bipyramid on a sphere") {
    // The faces have sides sqrt 2, sqrt 2, sqrt 3: the cosine of the apex angle is (2 + 2 - 3)/4 =
    // 1/4. Q is twice its excess over 60 degrees (once itself, once the two others together) / 240.
    const double apex = std::acos(0.25) * 180 / kPi;
    CHECK(regularity(bipyramid(), Regularity::AngleOnly) ==
          Approx(1 - 2 * (apex - 60) / 240).epsilon(1e-12));
    CHECK(regularity(bipyramid(), Regularity::EdgeOnly) ==
          Approx(std::sqrt(2.0 / 3.0)).epsilon(1e-12));
    CHECK(regularity(bipyramid(), Regularity::AngleOnly) == Approx(0.87).margin(0.005));
    CHECK(regularity(bipyramid(), Regularity::EdgeOnly) == Approx(0.82).margin(0.005));
    CHECK(regularity(bipyramid(), Regularity::Combined) == Approx(0.84).margin(0.005));
  }
  SECTION("a box counts its twelve edges, not the diagonals of its faces") {
    std::vector<Vector3d> points;
    for (int i = 0; i < 8; ++i) points.emplace_back(i & 1, 2 * ((i >> 1) & 1), 4 * ((i >> 2) & 1));
    CHECK(regularity(points, Regularity::EdgeOnly) == Approx(0.25).epsilon(kRounding));
    CHECK(regularity(points, Regularity::AngleOnly) == Approx(1.0).epsilon(kRounding));
    CHECK(regularity(points, Regularity::Combined) == Approx(0.5).epsilon(kRounding));
  }
  SECTION("points inside the hull do not matter") {
    std::vector<Vector3d> points = bipyramid();
    const double without = regularity(points, Regularity::Combined);
    points.emplace_back(0.1, 0.05, 0.2);
    CHECK(regularity(points, Regularity::Combined) == Approx(without).epsilon(1e-12));
  }
}

TEST_CASE("Collinear, coincident, few points: the documented regularity", "[contact][regularity]") {
  const Vector3d a(0.1, 0.2, 0.3);
  const Vector3d u = Vector3d(1, -2, 0.5).normalized();
  using Points = std::vector<Vector3d>;
  const Regularity definition =
      GENERATE(Regularity::Combined, Regularity::AngleOnly, Regularity::EdgeOnly);
  CHECK(regularity(Points{}, definition) == 0.0);
  CHECK(regularity(Points{a}, definition) == 0.0);
  CHECK(regularity(Points{a, a + u}, definition) == 1.0);
  CHECK(regularity(Points{a, a + u, a + 3 * u}, definition) == 1e-3);
  CHECK(regularity(Points{a, a + u, a + u}, definition) == 1e-3);
  CHECK(regularity(Points{a, a, a}, definition) == 1e-3);
}

TEST_CASE("Close contacts are one point of the hull, in whatever order they come",
          "[contact][regularity]") {
  std::vector<Vector3d> points = equator(120, 120);
  points.push_back(points[0] + Vector3d(0, 0.008, 0));
  points.push_back(points[0] -
                   Vector3d(0, 0.008, 0));  // It is 0.016 from the last, linked through the first.
  // Apart they are a thin pentagon; merged by their mean they are the triangle again.
  CHECK(regularity(points, Regularity::Combined) < 0.2);
  std::sort(points.begin(), points.end(),
            [](const Vector3d& a, const Vector3d& b) { return a.y() < b.y(); });
  CHECK(regularity(points, Regularity::Combined, 0.01) == Approx(1.0).epsilon(kRounding));
  std::reverse(points.begin(), points.end());
  CHECK(regularity(points, Regularity::Combined, 0.01) == Approx(1.0).epsilon(kRounding));
  // Three contacts of which two merge are collinear and not a pair.
  CHECK(regularity(std::vector<Vector3d>{{0, 0, 0}, {1, 0, 0}, {1, 0.001, 0}}, Regularity::Combined,
                   0.01) == 1e-3);
}

TEST_CASE("Four nearly planar contacts are a polygon below thickness 0.1 and a solid above",
          "[contact][regularity]") {
  // The corners are (±1, ±1/2) at heights ±t/2, with the sign of x y. The principal axes are x, y,
  // z, the extent is 2 and the thickness t, so the branch is at t = 0.2. The planar hull is the
  // rectangle, with R = sqrt(1 * 1/2). The solid one has four equal faces with sides sqrt 5
  // (between corners of one height), sqrt(4 + t²), sqrt(1 + t²).
  const auto points = [](double t) {
    return std::vector<Vector3d>{
        {1, 0.5, t / 2}, {-1, 0.5, -t / 2}, {-1, -0.5, t / 2}, {1, -0.5, -t / 2}};
  };
  const auto solid = [](double t) {
    const double a2 = 5, b2 = 4 + t * t, c2 = 1 + t * t;
    double deviation = 0.0;
    for (const auto& [x2, y2, z2] : {std::array{a2, b2, c2}, {b2, c2, a2}, {c2, a2, b2}}) {
      const double angle = std::acos((y2 + z2 - x2) / (2 * std::sqrt(y2 * z2)));
      deviation += std::abs(angle - kPi / 3);
    }
    const double angles = 1 - deviation / (4 * kPi / 3);
    return std::sqrt(angles * std::sqrt(c2 / a2));
  };
  const double planar = std::sqrt(0.5);
  CHECK(regularity(points(0.0), Regularity::Combined) == Approx(planar).epsilon(1e-12));
  CHECK(regularity(points(0.1), Regularity::Combined) == Approx(planar).epsilon(1e-12));
  // Principal axes come from an eigenvalue problem, for which 1e-12 is some thousand roundings.
  CHECK(regularity(points(0.2 * (1 - 1e-12)), Regularity::Combined) ==
        Approx(planar).epsilon(1e-9));
  CHECK(regularity(points(0.2 * (1 + 1e-12)), Regularity::Combined) ==
        Approx(solid(0.2)).epsilon(1e-9));
  CHECK(regularity(points(0.5), Regularity::Combined) == Approx(solid(0.5)).epsilon(1e-12));
  CHECK(std::abs(solid(0.2) - planar) > 0.1);  // This is a jump, as the two hulls differ.
}

TEST_CASE("A fifth contact raised over four is no corner below thickness 0.1, and an apex above",
          "[contact][regularity]") {
  // The points are a rhombus with diagonals 2 and 1.8 and a point over its center: the extent is 2,
  // and the thickness is the point's height. The planar hull is the rhombus, whatever the height,
  // as the point is within it.
  const auto points = [](double height) {
    return std::vector<Vector3d>{{1, 0, 0}, {0, 0.9, 0}, {-1, 0, 0}, {0, -0.9, 0}, {0, 0, height}};
  };
  // The angles are 2 atan(0.9) and π minus that; all edges are equal.
  const double planar =
      std::sqrt(1.0 - 4.0 * std::abs(2.0 * std::atan(0.9) - kPi / 2) / (2.0 * kPi));
  for (const double height : {0.0, 0.1, 0.2 * (1 - 1e-12)}) {
    CHECK(regularity(points(height), Regularity::Combined) == Approx(planar).epsilon(1e-9));
  }
  // In the solid hull the apex is nearer to (0, ±0.9, 0), at √(0.81 + h²), than those are to (±1,
  // 0, 0).
  const double h = 0.2 * (1 + 1e-12);
  CHECK(regularity(points(h), Regularity::EdgeOnly) ==
        Approx(std::sqrt((0.81 + h * h) / 1.81)).epsilon(1e-9));
  CHECK(regularity(points(h), Regularity::Combined) < planar - 0.1);
}

TEST_CASE("Regularity is continuous away from the documented branches", "[contact][regularity]") {
  const std::vector<Vector3d> points =
      GENERATE(equator(120, 110), tetrahedron(), bipyramid(), octahedron());
  for (std::size_t moved = 0; moved < points.size(); ++moved) {
    for (const Vector3d& step :
         {Vector3d(1e-6, 0, 0), Vector3d(0, 1e-6, 0), Vector3d(0, 0, 1e-6)}) {
      std::vector<Vector3d> near = points;
      near[moved] += step;
      // The slope of R is below 3 per edge length here.
      CHECK(std::abs(regularity(near, Regularity::Combined) -
                     regularity(points, Regularity::Combined)) < 3e-6);
    }
  }
}

}  // namespace test_regularity
