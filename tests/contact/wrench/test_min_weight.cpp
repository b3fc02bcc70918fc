#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>

#include "contact/known_grasps.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/contact/grasp_wrench_space.hpp"
#include "graspfit/contact/min_weight.hpp"
#include "support/catch.hpp"

namespace test_min_weight {

using namespace graspfit;
using namespace graspfit::contact;
using base::Random;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using testing::antipodal;
using testing::Contacts;
using testing::on_cube;
using testing::on_tetrahedron;
using testing::random_contacts;

namespace {

constexpr double kClosedForm = 1e-9;

Wrenches wrenches_of(const Contacts& contacts, double friction, int num_edges = 8) {
  return contact_wrenches(
      contacts,
      {.options = {.num_cone_edges = num_edges, .friction = friction, .torque_scale = 1.0}});
}

/// Returns seven unit vectors in 6-D with equal angles between all: the coordinate axes in 7-D,
/// seen along their sum.
Wrenches simplex() {
  const MatrixXd centered = MatrixXd::Identity(7, 7).array() - 1.0 / 7.0;
  const MatrixXd basis =
      Eigen::FullPivHouseholderQR<MatrixXd>(centered).matrixQ() * MatrixXd::Identity(7, 6);
  Wrenches points = basis.transpose() * centered;
  points.colwise().normalize();
  return points;
}

}  // namespace

// Test cases that are named by one letter, A to G, share their wrenches with those of the same
// letter in test_grasp_wrench_space.cpp.

TEST_CASE("Cases A to G have the known min-weight", "[contact][min_weight]") {
  Wrenches cross(6, 12);
  cross << MatrixXd::Identity(6, 6), -MatrixXd::Identity(6, 6);
  const MinWeight a = min_weight(cross);
  CHECK(*a.weight == Approx(1.0 / 12.0).epsilon(kClosedForm));
  CHECK(a.normalized == Approx(1.0).epsilon(kClosedForm));
  CHECK(a.smallest_singular == Approx(std::sqrt(2.0)).epsilon(kClosedForm));
  CHECK(a.is_force_closure());

  const MinWeight b = min_weight(simplex());
  CHECK(*b.weight == Approx(1.0 / 7.0).epsilon(kClosedForm));
  CHECK(b.is_force_closure());

  for (const double mu : {0.2, 0.5, 1.0}) {
    CAPTURE(mu);
    // Case C is a disk in the plane, whose wrenches span three dimensions of the six.
    Wrenches disk = Wrenches::Zero(6, 4);
    disk.topRows(3) << 1, 1, -1, -1, mu, -mu, mu, -mu, -mu, mu, mu, -mu;
    const MinWeight c = min_weight(disk);
    CHECK(*c.weight == Approx(0.25).epsilon(kClosedForm));
    CHECK(c.rank == 3);
    CHECK_FALSE(c.is_force_closure());

    CHECK(*min_weight(wrenches_of(on_cube(), mu, 4)).weight ==
          Approx(1.0 / 24.0).epsilon(kClosedForm));
    CHECK(*min_weight(wrenches_of(on_cube(), mu)).weight ==
          Approx(1.0 / 48.0).epsilon(kClosedForm));
    const MinWeight g = min_weight(wrenches_of(on_tetrahedron(), mu));
    CHECK(*g.weight == Approx(1.0 / 32.0).epsilon(kClosedForm));
    CHECK(g.is_force_closure());
  }
}

TEST_CASE(
    "Case E: two contacts opposite each other balance evenly and are not closed, however they "
    "are turned",
    "[contact][min_weight]") {
  Random random(51);
  for (const double mu : {0.2, 0.5, 1.0}) {
    const MinWeight e = min_weight(wrenches_of(antipodal(), mu));
    CHECK(*e.weight == Approx(1.0 / 16.0).epsilon(kClosedForm));
    CHECK(e.rank == 5);
    CHECK_FALSE(e.is_force_closure());
    for (int i = 0; i < 5; ++i) {
      const Vector3d axis = testing::random_direction(random);
      const MinWeight turned = min_weight(wrenches_of(testing::on_sphere({axis, -axis}), mu));
      CHECK(turned.rank == 5);
      CHECK_FALSE(turned.is_force_closure());
    }
  }
}

TEST_CASE(
    "The sign of the min-weight is force closure, and half of it times the smallest singular "
    "value is below epsilon",
    "[contact][min_weight]") {
  Random random(52);
  int num_closed = 0;
  constexpr int kGrasps = 40;
  for (int i = 0; i < kGrasps; ++i) {
    const GraspWrenchSpace space =
        grasp_wrench_space(random_contacts(random, 3 + i % 3), Vector3d::Zero(),
                           {.num_cone_edges = 4 + i % 5, .friction = 0.8, .torque_scale = 1.0});
    const MinWeight found = min_weight(space.wrenches);
    REQUIRE(found.rank == 6);
    REQUIRE(found.weight.has_value());
    // Three contacts may miss closure by rounding alone, and the two functions round differently.
    if (std::abs(*found.weight) < 1e-12) {
      CHECK(epsilon_quality(space) < 1e-12);
      continue;
    }
    CHECK((*found.weight > 0.0) == is_force_closure(space));
    CHECK(*found.weight <= 1.0 / static_cast<double>(space.wrenches.cols()) + 1e-15);
    if (!found.is_force_closure()) continue;
    ++num_closed;
    CHECK(epsilon_quality(space) >= 0.5 * *found.weight * found.smallest_singular);
  }
  CHECK(num_closed >= 10);
  CHECK(num_closed <= kGrasps - 10);
}

TEST_CASE("The min-weight does not change with scale, nor by any map of the wrenches",
          "[contact][min_weight]") {
  Random random(53);
  const Wrenches wrenches = wrenches_of(random_contacts(random, 5), 0.9);
  const double weight = *min_weight(wrenches).weight;
  Eigen::Matrix<double, 6, 6> map;
  for (double& x : map.reshaped()) x = random.uniform(-1.0, 1.0);
  CHECK(*min_weight(7.0 * map * wrenches).weight == Approx(weight).epsilon(1e-9).margin(1e-12));
}

TEST_CASE("Wrenches that cancel by no weights have no min-weight", "[contact][min_weight]") {
  const MinWeight one = min_weight(Wrenches(Wrench::Unit(2)));
  CHECK_FALSE(one.weight.has_value());
  CHECK(one.normalized == 0.0);
  CHECK(one.rank == 1);
  CHECK_FALSE(one.is_force_closure());
  const MinWeight none = min_weight(Wrenches(6, 0));
  CHECK_FALSE(none.weight.has_value());
  CHECK(none.rank == 0);
  // These cancel only by pulling: 2 w and w with the weights −1 and 2.
  Wrenches both(6, 2);
  both << 2.0 * Wrench::Unit(0), Wrench::Unit(0);
  CHECK(*min_weight(both).weight == Approx(-1.0).epsilon(kClosedForm));
  CHECK_THROWS_AS(min_weight(Wrenches(Wrench::Constant(std::nan("")))), base::InvalidInput);
}

}  // namespace test_min_weight
