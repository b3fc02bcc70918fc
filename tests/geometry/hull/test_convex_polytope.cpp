#include <CGAL/Gmpq.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/convex_polytope.hpp"
#include "support/catch.hpp"
#include "support/qhull.hpp"

namespace test_convex_polytope {

using namespace graspfit::base;
using namespace graspfit::geometry;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Indices = std::vector<int>;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double factorial(int n) { return n < 2 ? 1.0 : n * factorial(n - 1); }

Indices numbers_up_to(int count) {
  Indices all(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) all[i] = i;
  return all;
}

MatrixXd cube(int d) {
  MatrixXd points(d, 1 << d);
  for (int i = 0; i < points.cols(); ++i) {
    for (int j = 0; j < d; ++j) points(j, i) = i >> j & 1 ? 1.0 : -1.0;
  }
  return points;
}

MatrixXd cross_polytope(int d) {
  MatrixXd points(d, 2 * d);
  points << MatrixXd::Identity(d, d), -MatrixXd::Identity(d, d);
  return points;
}

/// Returns the origin and the unit vectors.
MatrixXd corner_simplex(int d) {
  MatrixXd points(d, d + 1);
  points << VectorXd::Zero(d), MatrixXd::Identity(d, d);
  return points;
}

MatrixXd random_points(Random& random, int d, int count) {
  MatrixXd points(d, count);
  for (double& x : points.reshaped()) x = random.uniform(-1.0, 1.0);
  return points;
}

/// Returns integer coordinates in 0 … size − 1, with many coplanar, collinear and equal points.
MatrixXd lattice_points(Random& random, int d, int count, int size) {
  MatrixXd points(d, count);
  for (double& x : points.reshaped()) {
    x = static_cast<double>(random.index(static_cast<std::uint64_t>(size)));
  }
  return points;
}

/// Returns the sign of det(p_1 − p_0, …, p_d − p_0) in rationals, the oracle of every side.
int exact_orientation(const MatrixXd& corners) {
  const auto d = static_cast<int>(corners.rows());
  std::vector<std::vector<CGAL::Gmpq>> m(static_cast<std::size_t>(d));
  for (int i = 0; i < d; ++i) {
    for (int j = 0; j < d; ++j) {
      m[i].push_back(CGAL::Gmpq(corners(j, i + 1)) - CGAL::Gmpq(corners(j, 0)));
    }
  }
  int sign = 1;
  for (int k = 0; k < d; ++k) {
    int pivot = k;
    while (pivot < d && m[pivot][k] == 0) ++pivot;
    if (pivot == d) return 0;
    if (pivot != k) {
      std::swap(m[pivot], m[k]);
      sign = -sign;
    }
    if (m[k][k] < 0) sign = -sign;
    for (int i = k + 1; i < d; ++i) {
      const CGAL::Gmpq factor = m[i][k] / m[k][k];
      for (int j = k; j < d; ++j) m[i][j] -= factor * m[k][j];
    }
  }
  return sign;
}

/// Returns the number of hyperplanes in which facets lie, exactly: facets of one plane have the
/// same vertices on it. Precondition: the first `rank` coordinates tell all points of the span
/// apart.
int num_facet_planes(const ConvexPolytope& polytope) {
  const int rank = polytope.rank();
  std::set<Indices> planes;
  MatrixXd corners(rank, rank + 1);
  for (Index f = 0; f < polytope.num_facets(); ++f) {
    for (int k = 0; k < rank; ++k) {
      corners.col(k) = polytope.points().col(polytope.facets()(k, f)).head(rank);
    }
    Indices on_plane;
    for (const int vertex : polytope.vertices()) {
      const auto point = polytope.points().col(vertex);
      // Doubles tell what is plainly beneath: they are good to 1e-10 of coordinates up to 1000.
      if (polytope.normals().col(f).dot(point) < polytope.offsets()[f] - 1e-6) continue;
      corners.col(rank) = point.head(rank);
      if (exact_orientation(corners) == 0) on_plane.push_back(vertex);
    }
    planes.insert(on_plane);
  }
  return static_cast<int>(planes.size());
}

/// Checks exactly that every facet is a simplex with all points on it or beneath it, and that each
/// ridge has two.
void check_boundary(const ConvexPolytope& polytope) {
  const int d = polytope.dimension();
  REQUIRE(polytope.rank() == d);
  std::map<std::set<int>, int> facets_of_ridge;
  MatrixXd corners(d, d + 1);
  int num_wrong = 0;
  for (Index f = 0; f < polytope.num_facets(); ++f) {
    std::set<int> facet;
    for (int k = 0; k < d; ++k) {
      facet.insert(polytope.facets()(k, f));
      corners.col(k) = polytope.points().col(polytope.facets()(k, f));
    }
    int num_beneath = 0;
    for (Index p = 0; p < polytope.points().cols(); ++p) {
      corners.col(d) = polytope.points().col(p);
      const int side = exact_orientation(corners);
      num_wrong += side > 0;
      num_beneath += side < 0;
    }
    num_wrong += num_beneath == 0;
    for (int k = 0; k < d; ++k) {
      std::set<int> ridge = facet;
      ridge.erase(polytope.facets()(k, f));
      ++facets_of_ridge[ridge];
      const Index neighbor = polytope.neighbors()(k, f);
      for (const int corner : ridge) {
        num_wrong += (polytope.facets().col(neighbor).array() == corner).count() != 1;
      }
    }
  }
  for (const auto& [ridge, count] : facets_of_ridge) num_wrong += count != 2;
  CHECK(num_wrong == 0);
}

}  // namespace

TEST_CASE("Cube, simplex and cross-polytope have their facets, volume and inradius in 2 to 6-D",
          "[geometry][convex_polytope]") {
  const int d = GENERATE(range(2, 7));
  CAPTURE(d);
  struct Row {
    MatrixXd points;
    VectorXd center;
    int num_facets;
    double volume;
    double inradius;
  };
  // The inscribed ball of the corner simplex touches the planes x_j = 0 and Σ x_j = 1, so that r =
  // (1 − d r) / √d.
  const double r = 1.0 / (d + std::sqrt(d));
  for (const Row& row :
       {Row{cube(d), VectorXd::Zero(d), 2 * d, std::exp2(d), 1.0},
        Row{corner_simplex(d), VectorXd::Constant(d, r), d + 1, 1.0 / factorial(d), r},
        Row{cross_polytope(d), VectorXd::Zero(d), 1 << d, std::exp2(d) / factorial(d),
            1.0 / std::sqrt(d)}}) {
    const ConvexPolytope polytope(row.points);
    CHECK(polytope.vertices() == numbers_up_to(static_cast<int>(row.points.cols())));
    CHECK(num_facet_planes(polytope) == row.num_facets);
    CHECK(polytope.volume() == Approx(row.volume).epsilon(1e-14));
    CHECK(polytope.measure() == polytope.volume());
    CHECK(polytope.inradius(row.center) == Approx(row.inradius).epsilon(1e-14));
    CHECK(polytope.containment(row.center) == Containment::Inside);
    check_boundary(polytope);
  }
}

TEST_CASE("Hulls of random points are those of Qhull", "[geometry][convex_polytope]") {
  Random random(61);
  const int d = GENERATE(range(2, 7));
  for (const int count : {d + 1, 12, 40}) {
    CAPTURE(d, count);
    const MatrixXd points = random_points(random, d, count);
    const ConvexPolytope ours(points);
    const graspfit::testing::QhullResult other = graspfit::testing::qhull(points);
    REQUIRE(other.is_full);
    CHECK(ours.vertices() == other.vertices);
    CHECK(ours.volume() == Approx(other.volume).epsilon(1e-12));
    REQUIRE(num_facet_planes(ours) == other.planes.cols());
    // The planes are the same, if in another order. Random normals are farther apart than 1e-9.
    int num_found = 0;
    for (Index f = 0; f < ours.num_facets(); ++f) {
      VectorXd plane(d + 1);
      plane << ours.normals().col(f), -ours.offsets()[f];
      num_found += (other.planes.colwise() - plane).colwise().norm().minCoeff() < 1e-9;
    }
    CHECK(num_found == ours.num_facets());
    const VectorXd center = points.rowwise().mean();
    const double inradius =
        -(other.planes.topRows(d).transpose() * center + other.planes.row(d).transpose())
             .maxCoeff();
    CHECK(ours.inradius(center) == Approx(inradius).epsilon(1e-11));
  }
}

TEST_CASE("Boundaries are right in rationals, however degenerate the points",
          "[geometry][convex_polytope]") {
  Random random(62);
  const int d = GENERATE(range(2, 7));
  CAPTURE(d);
  SECTION("points on a small lattice") {
    for (const int size : {2, 3})
      check_boundary(ConvexPolytope(lattice_points(random, d, 20, size)));
  }
  SECTION("a cube with points within its faces") {
    MatrixXd points(d, (1 << d) + 12);
    points << cube(d), MatrixXd::Zero(d, 12);
    for (int i = 0; i < 12; ++i) {
      for (int j = 0; j < d; ++j) points(j, (1 << d) + i) = random.index(5) / 2.0 - 1.0;
      points(i % d, (1 << d) + i) = i % 2 != 0 ? 1.0 : -1.0;
    }
    const ConvexPolytope polytope(points);
    CHECK(polytope.vertices() == numbers_up_to(1 << d));
    CHECK(num_facet_planes(polytope) == 2 * d);
    CHECK(polytope.volume() == Approx(std::exp2(d)).epsilon(1e-13));
    check_boundary(polytope);
  }
  SECTION("points off a plane by less than their rounding, in some directions") {
    for (const double offset : {1e-17, 1e-30, 1e-200}) {
      MatrixXd points = random_points(random, d, d + 6);
      points.row(0) *= offset;
      const ConvexPolytope polytope(points);
      check_boundary(polytope);
      MatrixXd stretched = points;
      stretched.row(0) /= offset;
      CHECK(polytope.volume() / offset == Approx(ConvexPolytope(stretched).volume()).epsilon(1e-9));
    }
    // All points are nearly in a plane that no axis follows, as a third is always rounded.
    MatrixXd points = random_points(random, d, 16);
    points.row(0) = points.bottomRows(d - 1).colwise().sum() / 3.0;
    check_boundary(ConvexPolytope(points));
  }
}

TEST_CASE("A hull does not depend on the order of its points, nor on equal ones",
          "[geometry][convex_polytope]") {
  Random random(63);
  const int d = GENERATE(2, 3, 6);
  const bool is_degenerate = GENERATE(false, true);
  const MatrixXd points =
      is_degenerate ? lattice_points(random, d, 30, 3) : random_points(random, d, 20);
  // A boundary is the set of all facets, a facet the set of its corners' coordinates.
  const auto boundary = [](const ConvexPolytope& polytope) {
    std::set<std::set<std::vector<double>>> facets;
    for (Index f = 0; f < polytope.num_facets(); ++f) {
      std::set<std::vector<double>> facet;
      for (const int corner : polytope.facets().col(f)) {
        const VectorXd p = polytope.points().col(corner);
        facet.emplace(p.begin(), p.end());
      }
      facets.insert(facet);
    }
    return facets;
  };
  const ConvexPolytope polytope(points);
  MatrixXd shuffled(d, 2 * points.cols());
  shuffled << points.rowwise().reverse(), points;
  for (Index i = 0; i < shuffled.cols(); ++i) {
    const auto other = static_cast<Index>(random.index(static_cast<std::uint64_t>(i + 1)));
    shuffled.col(i).swap(shuffled.col(other));
  }
  const ConvexPolytope again(shuffled);
  CHECK(again.vertices().size() == polytope.vertices().size());
  CHECK(boundary(again) == boundary(polytope));
  CHECK(again.volume() == Approx(polytope.volume()).epsilon(1e-13));
  for (const int vertex : again.vertices()) {
    for (int i = 0; i < vertex; ++i) REQUIRE(shuffled.col(i) != shuffled.col(vertex));
  }
}

TEST_CASE("An affine map takes a hull to the hull", "[geometry][convex_polytope]") {
  Random random(64);
  const int d = GENERATE(range(2, 7));
  // The points are integers, so that the map rounds nothing and coplanar points stay coplanar.
  const MatrixXd points = lattice_points(random, d, 25, 4);
  MatrixXd map = MatrixXd::Identity(d, d);
  for (int i = 0; i < 3 * d; ++i) {
    const auto row = static_cast<Index>(random.index(static_cast<std::uint64_t>(d)));
    map.row(row) += (i % 2 != 0 ? 2.0 : -1.0) * map.row((row + 1) % d);
  }
  const MatrixXd image = (map * points).colwise() + VectorXd::LinSpaced(d, 1000.0, -500.0);
  const ConvexPolytope before(points);
  const ConvexPolytope after(image);
  CHECK(after.vertices() == before.vertices());
  CHECK(num_facet_planes(after) == num_facet_planes(before));
  CHECK(after.volume() == Approx(before.volume()).epsilon(1e-12));  // The determinant is 1.
}

TEST_CASE("Points of lower rank have a hull in their span, without volume or inside",
          "[geometry][convex_polytope]") {
  const int d = GENERATE(range(2, 7));
  for (int rank = 0; rank < d; ++rank) {
    CAPTURE(d, rank);
    // The points are a cube of that rank with its center, on axes of integers at right angles.
    const VectorXd shift = VectorXd::LinSpaced(d, 1.0, d);
    const MatrixXd corners = rank > 0 ? cube(rank) : MatrixXd::Zero(1, 1);
    MatrixXd axes = MatrixXd::Zero(d, rank);
    for (int k = 0; k < rank; ++k) axes(k, k) = 1.0;
    // They are collinear, but not along an axis.
    if (rank == 1) axes = VectorXd::Constant(d, 1.0);
    MatrixXd points(d, corners.cols() + 1);
    points << (rank > 0 ? MatrixXd((axes * corners).colwise() + shift) : MatrixXd(shift)), shift;
    const ConvexPolytope polytope(points);
    CHECK(polytope.rank() == rank);
    CHECK(polytope.vertices() == numbers_up_to(rank > 0 ? 1 << rank : 1));
    CHECK(polytope.volume() == 0.0);
    const double side = rank == 1 ? 2.0 * std::sqrt(d) : 2.0;
    CHECK(polytope.measure() == Approx(rank == 0 ? 0.0 : std::pow(side, rank)).epsilon(1e-13));
    CHECK(num_facet_planes(polytope) == 2 * rank);
    CHECK(polytope.containment(shift) == Containment::OnSurface);
    CHECK(polytope.inradius(shift) == 0.0);
    VectorXd off = shift;
    off[d - 1] += 0x1p-45;
    CHECK(polytope.containment(off) == Containment::Outside);
    CHECK(polytope.inradius(off) < 0.0);
    CHECK(polytope.inradius(off) >= -0x1p-45 - 2e-15);  // Coordinates are up to 7.
    if (rank > 0) {
      const VectorXd beyond = shift + 1.5 * axes.col(0);
      CHECK(polytope.containment(beyond) == Containment::Outside);
      CHECK(polytope.inradius(beyond) == Approx(-0.25 * side).epsilon(1e-13));
      CHECK(polytope.containment(shift + axes.col(0)) == Containment::OnSurface);
      CHECK((polytope.normals().colwise().norm().array() - 1.0).abs().maxCoeff() < 1e-14);
    }
  }
}

TEST_CASE("Few points, equal points and none have documented hulls",
          "[geometry][convex_polytope]") {
  const ConvexPolytope none(MatrixXd(4, 0));
  CHECK(none.rank() == -1);
  CHECK(none.vertices().empty());
  CHECK(none.num_facets() == 0);
  CHECK(none.containment(VectorXd::Zero(4)) == Containment::Outside);
  CHECK(none.inradius(VectorXd::Zero(4)) == -kInfinity);

  const ConvexPolytope equal(MatrixXd::Constant(3, 5, 0.1));
  CHECK(equal.rank() == 0);
  CHECK(equal.vertices() == Indices{0});
  CHECK(equal.containment(VectorXd::Constant(3, 0.1)) == Containment::OnSurface);
  CHECK(equal.inradius(VectorXd::Constant(3, 0.1)) == 0.0);
  CHECK(equal.inradius(VectorXd::Constant(3, 1.1)) == Approx(-std::sqrt(3.0)));

  MatrixXd zeros(2, 3);  // Both zeros are one.
  zeros << 0.0, -0.0, 1.0, -0.0, 0.0, 1.0;
  CHECK(ConvexPolytope(zeros).vertices() == Indices{0, 2});
}

TEST_CASE("Containment is exact on facets and an ulp beside them", "[geometry][convex_polytope]") {
  Random random(65);
  const int d = GENERATE(range(2, 7));
  CAPTURE(d);
  // Corners are multiples of 1/8, so that means of 2^k of them are exact, as is 2^-52 next to them.
  MatrixXd points = lattice_points(random, d, 14, 40) / 8.0;
  points.array() -= 2.5;
  const ConvexPolytope polytope(points);
  REQUIRE(polytope.rank() == d);
  MatrixXd corners(d, d + 1);
  int num_on_surface = 0;
  for (Index f = 0; f < std::min(polytope.num_facets(), 60); ++f) {
    const VectorXd middle =
        0.5 * (points.col(polytope.facets()(0, f)) + points.col(polytope.facets()(1, f)));
    CHECK(polytope.containment(middle) == Containment::OnSurface);
    CHECK(polytope.inradius(middle) == 0.0);
    // A point a little along each axis is compared with every facet in rationals.
    for (int j = 0; j < d; ++j) {
      VectorXd near = middle;
      near[j] += j % 2 != 0 ? 0x1p-50 : -0x1p-50;
      int largest = -1;
      for (Index g = 0; g < polytope.num_facets(); ++g) {
        for (int k = 0; k < d; ++k) corners.col(k) = points.col(polytope.facets()(k, g));
        corners.col(d) = near;
        largest = std::max(largest, exact_orientation(corners));
      }
      const Containment containment = polytope.containment(near);
      num_on_surface += containment == Containment::OnSurface;
      CHECK(containment == std::array{Containment::Inside, Containment::OnSurface,
                                      Containment::Outside}[largest + 1]);
      const double inradius = polytope.inradius(near);
      CHECK((inradius > 0.0) - (inradius < 0.0) == -largest);
      CHECK(std::abs(inradius) <= 0x1p-49);
    }
  }
  CHECK(num_on_surface < 60 * d);
}

TEST_CASE("Inradii far below the rounding of coordinates keep sign and size",
          "[geometry][convex_polytope]") {
  const int d = GENERATE(range(2, 7));
  // Half a cross-polytope is a cone whose base passes the origin at `gap`.
  for (const double gap : {0x1p-60, -0x1p-60, 0x1p-300, -0x1p-300, 0.0}) {
    MatrixXd points = cross_polytope(d);
    points.row(0).setConstant(gap);
    points(0, d) = -1.0;
    const ConvexPolytope polytope(points);
    CHECK(polytope.inradius(VectorXd::Zero(d)) == gap);
    CHECK(polytope.containment(VectorXd::Zero(d)) == (gap > 0.0   ? Containment::Inside
                                                      : gap < 0.0 ? Containment::Outside
                                                                  : Containment::OnSurface));
  }
}

TEST_CASE("Points and queries that make no sense are refused", "[geometry][convex_polytope]") {
  CHECK_THROWS_AS(ConvexPolytope(MatrixXd::Zero(1, 3)), InvalidInput);
  CHECK_THROWS_AS(ConvexPolytope(MatrixXd::Zero(7, 3)), InvalidInput);
  MatrixXd points = cube(3);
  points(1, 4) = kInfinity;
  CHECK_THROWS_WITH(ConvexPolytope(points), graspfit::testing::Contains("point 4 is not finite"));
  const ConvexPolytope polytope(cube(3));
  CHECK_THROWS_AS(polytope.containment(VectorXd::Zero(2)), InvalidInput);
  CHECK_THROWS_AS(polytope.inradius(VectorXd::Constant(3, std::nan(""))), InvalidInput);
}

TEST_CASE("Coordinates from 1e-80 to 1e80 and far from the origin are no matter",
          "[geometry][convex_polytope]") {
  Random random(66);
  const MatrixXd points = lattice_points(random, 4, 18, 5);
  const ConvexPolytope plain(points);
  for (const double scale : {0x1p-260, 0x1p260}) {
    const ConvexPolytope scaled(points * scale);
    CHECK(scaled.vertices() == plain.vertices());
    CHECK(scaled.facets() == plain.facets());
    CHECK(scaled.normals().isApprox(plain.normals(), 1e-13));
  }
  const ConvexPolytope moved(points.array() + 0x1p40);
  CHECK(moved.facets() == plain.facets());
  CHECK(moved.volume() == Approx(plain.volume()).epsilon(1e-13));
  // One axis is out of the range of the filter, so that everything is decided in integers.
  MatrixXd wide = points;
  wide.row(2) *= 0x1p1000;
  wide(2, 0) = 0x1p-1000;
  check_boundary(ConvexPolytope(wide));
}

TEST_CASE("Corners so near each other that products of their distances underflow are told apart",
          "[geometry][convex_polytope]") {
  Random random(67);
  const int d = GENERATE(range(2, 7));
  CAPTURE(d);
  // Of a facet with all its corners in the cluster the product of squared lengths of d − 1 edges is
  // about 1e-340. The first point in the order of coordinates, from which differences are taken, is
  // far away.
  const double size = std::pow(1e-170, 1.0 / (d - 1));
  for (int round = 0; round < 5; ++round) {
    MatrixXd points(d, 2 * d + 4);
    points << random_points(random, d, d + 3) * size,
        random_points(random, d, d + 1) + MatrixXd::Constant(d, d + 1, -2.0);
    check_boundary(ConvexPolytope(points));
  }
}

TEST_CASE("Containment is exact for points so near a corner that squares underflow",
          "[geometry][convex_polytope]") {
  Random random(68);
  const int d = GENERATE(range(2, 7));
  CAPTURE(d);
  MatrixXd points(d, d + 1);
  points << VectorXd::Zero(d), random_points(random, d, d);
  const ConvexPolytope polytope(points);
  REQUIRE(polytope.rank() == d);
  MatrixXd corners(d, d + 1);
  int num_outside = 0;
  for (int i = 0; i < 50; ++i) {
    // The point is as near to a facet as rounding permits.
    VectorXd point = VectorXd::Zero(d);
    for (int k = 1; k <= d; ++k) {
      if (k != 1 + i % d) point += random.uniform() * 1e-165 * points.col(k);
    }
    int largest = -1;
    for (Index f = 0; f < polytope.num_facets(); ++f) {
      for (int k = 0; k < d; ++k) corners.col(k) = points.col(polytope.facets()(k, f));
      corners.col(d) = point;
      largest = std::max(largest, exact_orientation(corners));
    }
    num_outside += largest > 0;
    CHECK(polytope.containment(point) == std::array{Containment::Inside, Containment::OnSurface,
                                                    Containment::Outside}[largest + 1]);
    const double inradius = polytope.inradius(point);
    CHECK((inradius > 0.0) - (inradius < 0.0) == -largest);
  }
  CHECK(num_outside > 5);
}

}  // namespace test_convex_polytope
