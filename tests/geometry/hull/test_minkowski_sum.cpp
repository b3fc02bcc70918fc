#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/minkowski_sum.hpp"
#include "support/catch.hpp"
#include "support/qhull.hpp"

namespace test_minkowski_sum {

using namespace graspfit::base;
using namespace graspfit::geometry;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Summands = std::vector<MatrixXd>;

namespace {

constexpr double kRounding = 1e-12;

/// Returns pyramids over polygons in three dimensions of the space, as seen from the origin as from
/// a contact.
Summands random_cones(Random& random, int count, int num_edges, int dimension = 6) {
  Summands cones;
  for (int k = 0; k < count; ++k) {
    MatrixXd map(dimension, 3);
    for (double& x : map.reshaped()) x = random.uniform(-1.0, 1.0);
    MatrixXd edges(3, num_edges);
    for (int i = 0; i < num_edges; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / num_edges;
      edges.col(i) << 0.6 * std::cos(angle), 0.6 * std::sin(angle), 1.0;
    }
    cones.push_back(map * edges);
  }
  return cones;
}

double support_value(const Summands& summands, const VectorXd& direction) {
  double sum = 0.0;
  for (const MatrixXd& summand : summands) {
    sum += std::max(0.0, (direction.transpose() * summand).maxCoeff());
  }
  return sum;
}

MatrixXd with_origin(const MatrixXd& summand) {
  MatrixXd points = MatrixXd::Zero(summand.rows(), summand.cols() + 1);
  points.leftCols(summand.cols()) = summand;
  return points;
}

/// Returns all sums of a column of each; the origin is a column, too.
MatrixXd all_sums(const Summands& summands) {
  MatrixXd sums = MatrixXd::Zero(summands[0].rows(), 1);
  for (const MatrixXd& summand : summands) {
    const MatrixXd points = with_origin(summand);
    MatrixXd next(sums.rows(), sums.cols() * points.cols());
    Index column = 0;
    for (const auto& a : sums.colwise()) {
      for (const auto& b : points.colwise()) next.col(column++) = a + b;
    }
    sums = next;
  }
  return sums;
}

/// Computes the inradius by enumeration, for pyramids with the origin as apex. A facet of the sum
/// is spanned by edges of the summands, so that its normal is orthogonal to as many of them as the
/// dimension less one. The least support value over all such directions is the inradius. No hull is
/// needed.
double enumerated_inradius(const Summands& cones) {
  std::vector<VectorXd> edges;
  for (const MatrixXd& cone : cones) {
    for (Index i = 0; i < cone.cols(); ++i) {
      edges.push_back(cone.col(i));
      edges.push_back(cone.col((i + 1) % cone.cols()) - cone.col(i));
    }
  }
  const auto dimension = static_cast<std::size_t>(cones[0].rows());
  double least = std::numeric_limits<double>::infinity();
  std::vector<std::size_t> chosen(dimension - 1);
  const auto visit = [&](const auto& self, std::size_t depth, std::size_t first) -> void {
    if (depth < dimension - 1) {
      for (std::size_t i = first; i < edges.size(); ++i) {
        chosen[depth] = i;
        self(self, depth + 1, i + 1);
      }
      return;
    }
    MatrixXd rows(dimension - 1, dimension);
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      rows.row(static_cast<Index>(k)) = edges[chosen[k]].transpose();
    }
    const Eigen::FullPivLU<MatrixXd> lu(rows);
    if (lu.rank() < rows.rows()) return;
    const VectorXd normal = lu.kernel().col(0).normalized();
    least = std::min({least, support_value(cones, normal), support_value(cones, -normal)});
  };
  visit(visit, 0, 0);
  return least;
}

}  // namespace

TEST_CASE("The largest ball in a sum of boxes, segments and balls' polytopes is the known one",
          "[geometry][minkowski_sum]") {
  // Two cubes with half edges 1 and 1/4 add up to a cube with half edge 5/4.
  MatrixXd cube(3, 8);
  for (int i = 0; i < 8; ++i) cube.col(i) << (i & 1) * 2 - 1, (i & 2) - 1, (i & 4) / 2 - 1;
  const Summands cubes = {cube, 0.25 * cube};
  const InradiusBounds of_cubes = minkowski_sum_inradius(cubes);
  CHECK(of_cubes.lower == 1.25);
  CHECK(of_cubes.upper == 1.25);
  CHECK(of_cubes.direction.cwiseAbs().maxCoeff() == 1.0);
  const ConvexPolytope sum = minkowski_sum(cubes);
  CHECK(sum.volume() == Approx(2.5 * 2.5 * 2.5).epsilon(kRounding));
  CHECK(sum.vertices().size() == 8);

  // Segments from −e_i to e_i add up to the cube, in 6-D.
  Summands segments;
  for (int j = 0; j < 6; ++j) {
    MatrixXd segment = MatrixXd::Zero(6, 2);
    segment.row(j) << -1.0, 1.0;
    segments.push_back(segment);
  }
  const InradiusBounds of_segments = minkowski_sum_inradius(segments);
  CHECK(of_segments.lower == Approx(1.0).epsilon(kRounding));
  CHECK(of_segments.upper == Approx(1.0).epsilon(kRounding));
  CHECK(minkowski_sum(segments).volume() == Approx(64.0).epsilon(kRounding));
}

TEST_CASE("Case C, L-infinity: a disk between two contacts", "[geometry][minkowski_sum]") {
  // The wrenches are those in the plane (two forces, a torque over the radius) of contacts at (±1,
  // 0).
  for (const double mu : {0.2, 0.5, 1.0}) {
    CAPTURE(mu);
    MatrixXd left(3, 2);
    MatrixXd right(3, 2);
    left << 1, 1, mu, -mu, -mu, mu;
    right << -1, -1, mu, -mu, mu, -mu;
    const InradiusBounds bounds = minkowski_sum_inradius(Summands{left, right});
    const double epsilon = 2.0 * mu / std::sqrt(2.0 + 4.0 * mu * mu);
    CHECK(bounds.lower == Approx(epsilon).epsilon(kRounding));
    CHECK(bounds.upper == Approx(epsilon).epsilon(kRounding));
    CHECK(enumerated_inradius({left, right}) == Approx(epsilon).epsilon(kRounding));
    const ConvexPolytope sum = minkowski_sum(Summands{with_origin(left), with_origin(right)});
    CHECK(sum.volume() == Approx(8.0 * mu * mu).epsilon(kRounding));
  }
}

TEST_CASE("The largest ball is that of Qhull's hull of all sums", "[geometry][minkowski_sum]") {
  Random random(91);
  int num_inside = 0;
  for (int i = 0; i < 32; ++i) {
    const int dimension = 3 + i % 4;
    const Summands cones =
        dimension == 6 ? random_cones(random, 3, 4) : random_cones(random, 3, 5, dimension);
    CAPTURE(i, dimension);
    const graspfit::testing::QhullResult all = graspfit::testing::qhull(all_sums(cones));
    REQUIRE(all.is_full);
    const double inradius = -all.planes.row(dimension).maxCoeff();
    const InradiusBounds bounds = minkowski_sum_inradius(cones);
    // Qhull merges facets that rounding bends.
    CHECK(bounds.lower == Approx(std::max(0.0, inradius)).margin(1e-10));
    CHECK(bounds.upper == Approx(std::max(0.0, inradius)).margin(1e-10));
    num_inside += inradius > 1e-9;
  }
  CHECK(num_inside >= 4);
  CHECK(num_inside <= 28);
}

TEST_CASE("The largest ball is that of the enumeration of edges", "[geometry][minkowski_sum]") {
  Random random(92);
  int num_inside = 0;
  for (int i = 0; i < 12; ++i) {
    const Summands cones = random_cones(random, 3, 4, i % 4 == 0 ? 6 : 4);
    const double inradius = enumerated_inradius(cones);
    const InradiusBounds bounds = minkowski_sum_inradius(cones);
    CHECK(bounds.lower == Approx(inradius).margin(1e-12));
    CHECK(bounds.upper == Approx(inradius).margin(1e-12));
    num_inside += inradius > 1e-9;
  }
  CHECK(num_inside >= 2);
}

TEST_CASE("The direction found has the upper bound as its support value, and bounds meet",
          "[geometry][minkowski_sum]") {
  Random random(93);
  for (int i = 0; i < 4; ++i) {
    Summands cones = random_cones(random, 4, 8);
    for (const MatrixXd& cone : random_cones(random, 1, 8)) cones.push_back(-cone);
    const InradiusBounds bounds = minkowski_sum_inradius(cones);
    if (bounds.upper == 0.0) continue;
    CHECK(bounds.direction.norm() == Approx(1.0).epsilon(kRounding));
    CHECK(support_value(cones, bounds.direction) == Approx(bounds.upper).epsilon(kRounding));
    CHECK(bounds.upper - bounds.lower <= 1e-11 * bounds.upper);
    // A turned sum has the same ball, a scaled one a scaled ball.
    MatrixXd any(6, 6);
    for (double& x : any.reshaped()) x = random.uniform(-1.0, 1.0);
    const MatrixXd turn = Eigen::HouseholderQR<MatrixXd>(any).householderQ();
    Summands moved;
    for (const MatrixXd& cone : cones) moved.push_back(3.0 * turn * cone);
    CHECK(minkowski_sum_inradius(moved).lower == Approx(3.0 * bounds.lower).epsilon(1e-9));
    // A budget that is too small leaves a gap, and says so.
    const InradiusBounds rough = minkowski_sum_inradius(cones, {.max_points = 14});
    CHECK(rough.lower <= bounds.upper);
    CHECK(rough.upper >= bounds.lower);
    CHECK(rough.lower < rough.upper);
  }
}

TEST_CASE("Sums that do not hold the origin inside have no ball", "[geometry][minkowski_sum]") {
  // The origin is a corner of every summand; these all reach up.
  MatrixXd up(3, 3);
  up << 1, -1, 0, 0, 1, -1, 1, 1, 1;
  const InradiusBounds bounds = minkowski_sum_inradius(Summands{up, up});
  CHECK(bounds.lower == 0.0);
  CHECK(bounds.upper == 0.0);
  CHECK(minkowski_sum_inradius(Summands{MatrixXd::Zero(6, 2)}).upper == 0.0);
  // Flat summands have no ball either.
  MatrixXd flat = MatrixXd::Zero(3, 4);
  flat.topRows(2) << 1, -1, 0, 0, 0, 0, 1, -1;
  CHECK(minkowski_sum_inradius(Summands{flat}).upper == 0.0);
  CHECK(minkowski_sum(Summands{flat, flat}).rank() == 2);
}

TEST_CASE("Summands that do not belong together are refused", "[geometry][minkowski_sum]") {
  const MatrixXd in_space = MatrixXd::Ones(3, 2);
  CHECK_THROWS_AS(minkowski_sum({}), InvalidInput);
  CHECK_THROWS_AS(minkowski_sum_inradius({}), InvalidInput);
  CHECK_THROWS_WITH(
      minkowski_sum(Summands{in_space, MatrixXd::Ones(2, 2)}),
      graspfit::testing::Contains("minkowski_sum: summands must have the same 2 to 6 rows") &&
          graspfit::testing::Contains("one is 2 x 2"));
  CHECK_THROWS_AS(minkowski_sum_inradius(Summands{MatrixXd::Ones(7, 2)}), InvalidInput);
  CHECK_THROWS_AS(minkowski_sum_inradius(Summands{MatrixXd(3, 0)}), InvalidInput);
  CHECK_THROWS_AS(minkowski_sum_inradius(Summands{MatrixXd::Constant(3, 1, std::nan(""))}),
                  InvalidInput);
  CHECK_THROWS_WITH(minkowski_sum_inradius(Summands{in_space}, {.relative_gap = -1.0}),
                    graspfit::testing::Contains("relative_gap = -1"));
  CHECK_THROWS_WITH(minkowski_sum_inradius(Summands{in_space}, {.max_points = 0}),
                    graspfit::testing::Contains("max_points = 0"));
}

}  // namespace test_minkowski_sum
