#include <Eigen/Geometry>
#include <cmath>

#include "contact/known_grasps.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/contact/epsilon_linf.hpp"
#include "graspfit/contact/grasp_wrench_space.hpp"
#include "support/catch.hpp"

namespace test_epsilon_linf {

using namespace graspfit;
using namespace graspfit::contact;
using base::Random;
using Eigen::Vector3d;
using testing::antipodal;
using testing::Contacts;
using testing::on_cube;
using testing::random_contacts;

namespace {

WrenchConvention convention_of(double friction, int num_edges = 8) {
  return {.options = {.num_cone_edges = num_edges, .friction = friction, .torque_scale = 1.0}};
}

/// Returns the largest wrench along an axis, which bounds ε: each of the contacts presses with at
/// most one.
double reach_along(const Contacts& contacts, const WrenchConvention& convention,
                   const Wrench& direction) {
  double sum = 0.0;
  const Wrenches wrenches = contact_wrenches(contacts, convention);
  const Eigen::Index edges = convention.options.num_cone_edges;
  for (Eigen::Index first = 0; first < wrenches.cols(); first += edges) {
    sum += std::max(0.0, (direction.transpose() * wrenches.middleCols(first, edges)).maxCoeff());
  }
  return sum;
}

}  // namespace

TEST_CASE("Epsilon, L-infinity, lies between epsilon and as many times that as contacts",
          "[contact][epsilon_linf]") {
  Random random(61);
  int num_closed = 0;
  for (int i = 0; i < 8; ++i) {
    const Contacts contacts = random_contacts(random, 3 + i % 3);
    const WrenchConvention convention = convention_of(0.8, 6);
    const double l1 = epsilon_quality(grasp_wrench_space(contacts, convention));
    const LInfinityEpsilon found = epsilon_linf(contacts, convention);
    CHECK((found.upper > 0.0) == (l1 > 0.0));
    CHECK(found.lower >= l1 * (1.0 - 1e-12));
    CHECK(found.upper <= l1 * static_cast<double>(contacts.size()) * (1.0 + 1e-12));
    CHECK(found.upper - found.lower <= 1e-9 * found.upper);
    for (int j = 0; j < 6; ++j) {
      CHECK(found.lower <= reach_along(contacts, convention, Wrench::Unit(j)) + 1e-12);
    }
    num_closed += l1 > 0.0;
  }
  CHECK(num_closed >= 2);
}

TEST_CASE(
    "Six contacts of a cube withstand no torque without friction, and with it what their friction "
    "can turn",
    "[contact][epsilon_linf]") {
  // Each of the six contacts of the cube pushes its own way alone, and about no axis is there a
  // torque.
  const LInfinityEpsilon none = epsilon_linf(on_cube(), convention_of(0.0));
  CHECK(none.upper == 0.0);
  // With friction the ball in the wrench space of the cube touches where torques run out: about an
  // axis four contacts turn with 4 mu at most.
  const double mu = 0.2;
  const LInfinityEpsilon cube = epsilon_linf(on_cube(), convention_of(mu));
  CHECK(cube.lower <= 4.0 * mu * (1.0 + 1e-12));
  CHECK(cube.lower >= mu * std::sqrt(2.0 / 3.0));
  CHECK(cube.num_points > 12);
  // The space is so regular that a thousand points may not close the bounds, but they come near.
  CHECK(cube.upper - cube.lower < 5e-3 * cube.upper);
}

TEST_CASE("Epsilon, L-infinity, does not change with the frame, nor with size at its torque scale",
          "[contact][epsilon_linf]") {
  Random random(62);
  Contacts contacts;
  while (contacts.size() < 4) {
    const Contacts one = random_contacts(random, 1);
    if (std::abs(one[0].inward_normal_O.x()) < 0.85) contacts.push_back(one[0]);
  }
  const WrenchConvention convention = convention_of(0.7);
  const double epsilon = epsilon_linf(contacts, convention).lower;
  CHECK(epsilon > 0.0);
  // About e_x the edges of the friction cones turn with the object.
  const Eigen::AngleAxisd about_x(0.83, Vector3d::UnitX());
  const Vector3d shift(0.3, -0.1, 0.2);
  Contacts moved = contacts;
  for (Contact& contact : moved) {
    contact.point_O = 2.5 * (about_x * contact.point_O) + shift;
    contact.inward_normal_O = about_x * contact.inward_normal_O;
  }
  WrenchConvention scaled = convention;
  scaled.options.torque_scale = 2.5;
  scaled.reference_point_O = shift;
  CHECK(epsilon_linf(moved, scaled).lower == Approx(epsilon).epsilon(1e-9).margin(1e-14));
}

TEST_CASE("Epsilon, L-infinity, is zero without closure and says its convention",
          "[contact][epsilon_linf]") {
  const LInfinityEpsilon two = epsilon_linf(antipodal(), convention_of(0.5));
  CHECK(two.lower == 0.0);
  CHECK(two.upper == 0.0);
  CHECK_THAT(describe_linf(convention_of(0.5)), testing::EndsWith("L-infinity, unit normal force"));
  CHECK(epsilon_linf({}, convention_of(0.5)).upper == 0.0);
  CHECK_THROWS_AS(epsilon_linf(antipodal(), convention_of(-0.5)), base::InvalidInput);
}

}  // namespace test_epsilon_linf
