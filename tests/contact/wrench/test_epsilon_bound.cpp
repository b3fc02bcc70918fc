#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "contact/known_grasps.hpp"
#include "contact/random_contacts.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/contact/epsilon_bound.hpp"
#include "graspfit/contact/wrench_convention.hpp"
#include "graspfit/geometry/convex_polytope.hpp"
#include "support/catch.hpp"

namespace test_epsilon_bound {

using namespace graspfit::contact;
using graspfit::base::InvalidInput;
using graspfit::base::Random;
using graspfit::testing::on_cube;
using graspfit::testing::random_contacts;
using graspfit::testing::unit_ball;

TEST_CASE("The bound of epsilon is the inradius of hulls known in closed form",
          "[contact][epsilon_bound]") {
  // ± e_i: facets at 1 / √6. With sides of other lengths a facet is at 1 / √(Σ 1 / a²).
  Wrenches axes(6, 12);
  axes << Wrenches::Identity(6, 6), -Wrenches::Identity(6, 6);
  CHECK(epsilon_bound(axes) == Approx(1.0 / std::sqrt(6.0)).epsilon(1e-12));
  double sum = 0.0;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double side = 1.0 + 0.5 * static_cast<double>(i);
    axes.row(i) *= side;
    sum += 1.0 / (side * side);
  }
  CHECK(epsilon_bound(axes) == Approx(1.0 / std::sqrt(sum)).epsilon(1e-12));
  // One wrench of all of them pushed out does not matter, one taken away leaves the origin on the
  // hull.
  Wrenches open = axes.leftCols(11);
  CHECK(epsilon_bound(open) <= 0.0);
  // All beyond a plane: a distance, negative.
  open.resize(6, 2);
  open << Wrench::Unit(0), Wrench::Unit(0) + Wrench::Unit(1);
  CHECK(epsilon_bound(open) == Approx(-1.0).epsilon(0.01));
  CHECK_THROWS_AS(epsilon_bound(Wrenches(6, 0)), InvalidInput);
  axes(0, 0) = std::nan("");
  CHECK_THROWS_AS(epsilon_bound(axes), InvalidInput);
}

TEST_CASE("The bound of epsilon is never below it, nearly always equal, and has its sign",
          "[contact][epsilon_bound]") {
  const WrenchObject object{.center_of_mass_O = Eigen::Vector3d::Zero(),
                            .largest_radius = 1.0,
                            .extents_O = Eigen::Vector3d::Constant(2.0)};
  Random random(29);
  int num_closed = 0;
  int num_equal = 0;
  for (int round = 0; round < 150; ++round) {
    const std::vector<Contact> contacts = random_contacts(random, 3 + round % 3);
    const double friction = random.uniform(0.2, 0.9);
    const double epsilon = signed_epsilon(contacts, object, friction);
    const Wrenches wrenches = contact_wrenches(
        contacts, wrench_convention(WrenchTool::Graspfit, object, contacts, friction));
    const double bound = epsilon_bound(wrenches);
    CAPTURE(round, friction, epsilon, bound);
    // A search that may end early says no more than what it was asked for.
    const double early = epsilon_bound(wrenches, 0.5 * bound + 0.1 * (round % 2));
    if (bound > 0.5 * bound + 0.1 * (round % 2)) {
      CHECK(early == bound);
    } else if (bound > 0.0) {
      CHECK(early >= bound);
      CHECK(early <= 0.5 * bound + 0.1 * (round % 2));
    }
    if (epsilon > 1e-9) {
      ++num_closed;
      CHECK(bound >= epsilon - 1e-9);
      num_equal += bound <= epsilon + 1e-9;
      CHECK(bound <= 1.5 * epsilon + 0.01);
    } else if (epsilon < -1e-9) {
      CHECK(bound <= 0.0);
    }
  }
  CHECK(num_closed >= 30);
  CHECK(num_equal >= (9 * num_closed) / 10);
  // Contacts as regular as these have facets that are nearest among their neighbors only.
  const double epsilon = signed_epsilon(on_cube(), object, 0.5);
  const double bound = epsilon_bound(
      contact_wrenches(on_cube(), wrench_convention(WrenchTool::Graspfit, object, on_cube(), 0.5)));
  CHECK(bound >= epsilon - 1e-9);
  CHECK(bound <= 1.1 * epsilon);
}

TEST_CASE("The least force of hulls known in closed form", "[contact][epsilon_bound]") {
  // ± e_i, forces first: 1 along an axis, 1 / √3 along a diagonal. Torques do not matter.
  Wrenches axes(6, 12);
  axes << Wrenches::Identity(6, 6), -Wrenches::Identity(6, 6);
  CHECK(least_force(axes) == Approx(1.0 / std::sqrt(3.0)).epsilon(1e-5));
  Wrenches with_torques = axes;
  with_torques.bottomRows(3) *= 100.0;
  CHECK(least_force(with_torques) == Approx(1.0 / std::sqrt(3.0)).epsilon(1e-3));
  // Weak along one axis: the axis counts, or with a the force along it, diagonals with
  // √3 / (2 + 1 / a).
  axes.row(1) *= 0.2;
  CHECK(least_force(axes) == Approx(0.2).epsilon(1e-5));
  axes.row(1) *= 2.5;
  CHECK(least_force(axes) == Approx(std::sqrt(3.0) / 4.0).epsilon(1e-5));
  // Nothing pulls along -e_0.
  Wrenches open(6, 11);
  open << axes.leftCols(6), axes.rightCols(5);
  CHECK(least_force(open) == Approx(0.0).margin(1e-5));
  CHECK_THROWS_AS(least_force(Wrenches(6, 0)), InvalidInput);
  axes(0, 0) = std::nan("");
  CHECK_THROWS_AS(least_force(axes), InvalidInput);
}

TEST_CASE("The least force is that of the exact hull", "[contact][epsilon_bound]") {
  Random random(31);
  int num_closed = 0;
  for (int round = 0; round < 60; ++round) {
    const std::vector<Contact> contacts = random_contacts(random, 3 + round % 3);
    const Wrenches wrenches = contact_wrenches(
        contacts,
        wrench_convention(WrenchTool::Graspfit, unit_ball(), contacts, random.uniform(0.3, 0.9)));
    const graspfit::geometry::ConvexPolytope hull(wrenches);
    const double found = least_force(wrenches);
    CAPTURE(round, found);
    if (!(hull.inradius(Wrench::Zero()) > 1e-6)) continue;
    ++num_closed;
    // A ray leaves the hull in the first plane of a facet.
    double expected = std::numeric_limits<double>::infinity();
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const int num_parts = std::abs(x) + std::abs(y) + std::abs(z);
          if (num_parts != 1 && num_parts != 3) continue;
          Wrench direction = Wrench::Zero();
          direction.head<3>() = Eigen::Vector3d(x, y, z).normalized();
          for (int i = 0; i < hull.num_facets(); ++i) {
            const double along = hull.normals().col(i).dot(direction);
            if (along > 1e-12) expected = std::min(expected, hull.offsets()[i] / along);
          }
        }
      }
    }
    CHECK(found == Approx(expected).epsilon(1e-3).margin(1e-5));
    // A search that may end early says no more than what it was asked for.
    CHECK(least_force(wrenches, 0.5 * found) == found);
    const double early = least_force(wrenches, 1.5 * found);
    CHECK(early >= found);
    CHECK(early <= 1.5 * found);
  }
  CHECK(num_closed >= 20);
}

}  // namespace test_epsilon_bound
