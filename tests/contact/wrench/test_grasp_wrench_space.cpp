#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "contact/known_grasps.hpp"
#include "contact/random_contacts.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/contact/grasp_wrench_space.hpp"
#include "support/catch.hpp"
#include "support/qhull.hpp"

namespace test_grasp_wrench_space {

using namespace graspfit::contact;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using graspfit::base::InvalidInput;
using graspfit::base::Random;
using graspfit::geometry::Containment;
using graspfit::geometry::ConvexPolytope;
using graspfit::testing::contact_at;
using graspfit::testing::Contacts;
using graspfit::testing::on_cube;
using graspfit::testing::on_sphere;
using graspfit::testing::on_tetrahedron;
using graspfit::testing::random_contacts;
using graspfit::testing::random_direction;

namespace {

GraspWrenchSpace space_of(const Contacts& contacts, double friction, int num_edges = 8) {
  return grasp_wrench_space(
      contacts, Vector3d::Zero(),
      {.num_cone_edges = num_edges, .friction = friction, .torque_scale = 1.0});
}

constexpr double kRounding = 1e-12;

}  // namespace

TEST_CASE("Epsilon with a sign is epsilon with closure, and below zero where the origin is cut off",
          "[contact][grasp_wrench_space]") {
  const WrenchObject object{.center_of_mass_O = Vector3d::Zero(),
                            .largest_radius = 1.0,
                            .extents_O = Vector3d::Constant(2.0)};
  Random random(11);
  int num_closed = 0;
  for (int round = 0; round < 40; ++round) {
    const Contacts contacts = random_contacts(random, 4);
    const double with_sign = signed_epsilon(contacts, object, 0.8);
    WrenchConvention convention = wrench_convention(WrenchTool::Graspfit, object, contacts, 0.8);
    const GraspWrenchSpace space = grasp_wrench_space(contacts, convention);
    CAPTURE(round, with_sign);
    if (is_force_closure(space)) {
      CHECK(with_sign == epsilon_quality(space));
      ++num_closed;
    } else {
      CHECK(with_sign <= 0.0);
    }
  }
  CHECK(num_closed > 0);
  CHECK(num_closed < 40);
  CHECK(signed_epsilon({}, object, 0.8) == -std::numeric_limits<double>::infinity());
  // Two contacts that push the same way: no force against them.
  const Contacts same_way = {contact_at({0, 0, -1}, {0, 0, 1}),
                             contact_at({0, 0.1, -1}, {0, 0, 1})};
  CHECK(signed_epsilon(same_way, object, 0.8) <= 0.0);
}

// Test cases that are named by one letter, A to G, share their wrenches with those of the same
// letter in test_min_weight.cpp.

TEST_CASE("Cases A and B: cross-polytope and regular simplex in 6-D",
          "[contact][grasp_wrench_space]") {
  Wrenches cross(6, 12);
  cross << MatrixXd::Identity(6, 6), -MatrixXd::Identity(6, 6);
  const ConvexPolytope a(cross);
  CHECK(a.inradius(Wrench::Zero()) == Approx(1.0 / std::sqrt(6.0)).epsilon(kRounding));
  CHECK(a.volume() == Approx(64.0 / 720.0).epsilon(kRounding));
  CHECK(is_force_closure(cross));

  // The vertices are unit vectors with products −1/6: six are columns of a factor of that Gram
  // matrix, the seventh is the negative of their sum.
  Eigen::Matrix<double, 6, 6> gram = Eigen::Matrix<double, 6, 6>::Constant(-1.0 / 6.0);
  gram.diagonal().setOnes();
  Wrenches simplex(6, 7);
  simplex.leftCols(6) = Eigen::Matrix<double, 6, 6>(gram.llt().matrixU());
  simplex.col(6) = -simplex.leftCols(6).rowwise().sum();
  const ConvexPolytope b(simplex);
  CHECK(b.inradius(Wrench::Zero()) == Approx(1.0 / 6.0).epsilon(kRounding));
  // The volume is √(n + 1) / n! · √((1 + 1/n)^n) for n = 6.
  CHECK(b.volume() == Approx(std::sqrt(7.0) / 720.0 * std::pow(7.0 / 6.0, 3.0)).epsilon(kRounding));
  CHECK(b.volume() == Approx(0.0058352154).epsilon(1e-7));
  CHECK(is_force_closure(simplex));
}

TEST_CASE("Case C: two contacts of a planar disk", "[contact][grasp_wrench_space]") {
  const double mu = GENERATE(0.2, 0.5, 1.0);
  MatrixXd wrenches(3, 4);   // The rows are force x, force y and torque / R.
  wrenches << -1, -1, 1, 1,  //
      mu, -mu, mu, -mu,      //
      mu, -mu, -mu, mu;
  const ConvexPolytope hull(wrenches);
  CHECK(hull.rank() == 3);
  CHECK(hull.inradius(Vector3d::Zero()) ==
        Approx(mu / std::sqrt(2.0 + mu * mu)).epsilon(kRounding));
  CHECK(hull.volume() == Approx(8.0 * mu * mu / 3.0).epsilon(kRounding));
  CHECK(hull.containment(Vector3d::Zero()) == Containment::Inside);
}

TEST_CASE("Case E: two opposite contacts have rank 5 and no closure",
          "[contact][grasp_wrench_space]") {
  for (const double mu : {0.2, 0.5, 1.0}) {
    for (int axis = 0; axis < 3; ++axis) {
      const WrenchQuality quality =
          wrench_quality(space_of(on_sphere({Vector3d::Unit(axis), -Vector3d::Unit(axis)}), mu));
      CHECK(quality.rank == 5);
      CHECK(quality.epsilon == 0.0);
      CHECK(quality.volume == 0.0);
      CHECK_FALSE(quality.is_force_closure);
    }
  }
}

TEST_CASE("Cases F and G: cube and sphere have the known epsilon and volume",
          "[contact][grasp_wrench_space]") {
  struct Row {
    Contacts contacts;
    int num_edges;
    double friction, epsilon, volume;
  };
  for (const Row& row : {
           Row{on_cube(), 4, 0.2, 0.2 / std::sqrt(3.0), 0.0146432},
           Row{on_cube(), 4, 0.5, 0.5 / std::sqrt(3.0), 0.3125},
           Row{on_cube(), 4, 1.0, 1.0 / std::sqrt(3.0), 4.08888889},
           Row{on_cube(), 8, 0.2, 0.2 * std::sqrt(2.0 / 3.0), 0.0249923943},
           Row{on_cube(), 8, 0.5, 0.5 * std::sqrt(2.0 / 3.0), 0.598633733},
           Row{on_cube(), 8, 1.0, 1.0 * std::sqrt(2.0 / 3.0), 10.6159516},
           Row{on_tetrahedron(), 8, 0.2, 0.137258387, 0.00921812755},
           Row{on_tetrahedron(), 8, 0.5, 0.343027459, 0.269792862},
           Row{on_tetrahedron(), 8, 1.0, 0.689185670, 5.58898096},
       }) {
    CAPTURE(row.contacts.size(), row.num_edges, row.friction);
    const WrenchQuality quality =
        wrench_quality(space_of(row.contacts, row.friction, row.num_edges));
    // The cube has closed forms; the values of the others are known to nine digits.
    CHECK(quality.epsilon ==
          Approx(row.epsilon).epsilon(row.contacts.size() == 6 ? kRounding : 3e-9));
    CHECK(quality.volume == Approx(row.volume).epsilon(3e-9));
    CHECK(quality.is_force_closure);
    CHECK(quality.rank == 6);
    CHECK(quality.convention.options.num_cone_edges == row.num_edges);
  }
}

TEST_CASE("Epsilon and volume of random contacts are those of Qhull's hull",
          "[contact][grasp_wrench_space]") {
  Random random(81);
  int num_closed = 0;
  for (int i = 0; i < 24; ++i) {
    const int count = 3 + i % 3;
    const GraspWrenchSpace space = space_of(random_contacts(random, count), 0.8, 4 + i % 5);
    const graspfit::testing::QhullResult other = graspfit::testing::qhull(space.wrenches);
    REQUIRE(other.is_full);
    const WrenchQuality quality = wrench_quality(space);
    // Qhull merges facets that rounding bends, and loses up to 1e-11 thereby.
    CHECK(quality.volume == Approx(other.volume).epsilon(1e-9));
    const double other_epsilon = -other.planes.row(6).maxCoeff();
    CHECK(quality.epsilon == Approx(std::max(0.0, other_epsilon)).margin(1e-10));
    CHECK(quality.is_force_closure == (other_epsilon > 0.0));
    num_closed += quality.is_force_closure;
  }
  CHECK(num_closed >= 4);
  CHECK(num_closed <= 20);
}

TEST_CASE("Epsilon and volume do not change with the frame, nor with size at its torque scale",
          "[contact][grasp_wrench_space]") {
  Random random(82);
  for (int i = 0; i < 5; ++i) {
    Contacts contacts;
    while (contacts.size() < 4) {
      const Contacts one = random_contacts(random, 1);
      if (std::abs(one[0].inward_normal_O.x()) < 0.85) contacts.push_back(one[0]);
    }
    const Vector3d com(0.1, -0.05, 0.2);
    const WrenchSpaceOptions options{.friction = 0.7, .torque_scale = 1.3};
    const GraspWrenchSpace space = grasp_wrench_space(contacts, com, options);
    const WrenchQuality quality = wrench_quality(space);

    // About e_x the edges of the friction cones turn with the object, so that the hull is the same,
    // turned.
    const Eigen::AngleAxisd about_x(random.uniform(0.0, 6.0), Vector3d::UnitX());
    const Vector3d shift = random_direction(random);
    Contacts moved = contacts;
    for (Contact& contact : moved) {
      contact.point_O = 2.5 * (about_x * contact.point_O) + shift;
      contact.inward_normal_O = about_x * contact.inward_normal_O;
    }
    WrenchSpaceOptions scaled = options;
    scaled.torque_scale.value() *= 2.5;
    const WrenchQuality again =
        wrench_quality(grasp_wrench_space(moved, 2.5 * (about_x * com) + shift, scaled));
    CHECK(again.epsilon == Approx(quality.epsilon).epsilon(1e-9).margin(1e-14));
    CHECK(again.volume == Approx(quality.volume).epsilon(1e-9));
    CHECK(again.is_force_closure == quality.is_force_closure);

    // About any other axis the wrenches themselves are turned.
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(random.uniform(0.0, 6.0), random_direction(random)).matrix();
    Wrenches turned = space.wrenches;
    turned.topRows(3) = turn * space.wrenches.topRows(3);
    turned.bottomRows(3) = turn * space.wrenches.bottomRows(3);
    const ConvexPolytope hull(turned);
    CHECK(hull.volume() == Approx(quality.volume).epsilon(1e-9));
    CHECK(std::max(0.0, hull.inradius(Wrench::Zero())) ==
          Approx(quality.epsilon).epsilon(1e-9).margin(1e-14));
  }
}

TEST_CASE("Closure is exact where epsilon is 1e-18, zero and below",
          "[contact][grasp_wrench_space]") {
  // This is half a cross-polytope with its base at `gap`.
  for (const double gap : {0x1p-60, 0.0, -0x1p-60}) {
    Wrenches wrenches(6, 11);
    wrenches.col(0) = -Wrench::Unit(0);
    for (int k = 1; k < 6; ++k) {
      wrenches.col(2 * k - 1) = Wrench::Unit(k);
      wrenches.col(2 * k) = -Wrench::Unit(k);
    }
    wrenches.row(0).tail(10).setConstant(gap);
    CHECK(is_force_closure(wrenches) == (gap > 0.0));
    CHECK(ConvexPolytope(wrenches).inradius(Wrench::Zero()) == gap);
  }
  Wrenches bad = Wrenches::Zero(6, 3);
  bad(4, 1) = std::nan("");
  CHECK_THROWS_AS(is_force_closure(bad), InvalidInput);
}

TEST_CASE("The early no to closure is never wrong and often given",
          "[contact][grasp_wrench_space]") {
  Random random(83);
  int num_early = 0;
  int num_open = 0;
  for (int i = 0; i < 60; ++i) {
    const GraspWrenchSpace space = space_of(random_contacts(random, 2 + i % 4), 0.6, 6);
    const bool is_closed = is_force_closure(space);
    const bool is_early = is_surely_no_force_closure(space.wrenches);
    CHECK(is_force_closure(space.wrenches) == is_closed);
    CHECK_FALSE((is_early && is_closed));
    num_early += is_early;
    num_open += !is_closed;
  }
  CHECK(num_early > num_open / 2);
  CHECK_FALSE(is_surely_no_force_closure(space_of(on_cube(), 0.2).wrenches));
  CHECK(is_surely_no_force_closure(Wrenches(6, 0)));
}

TEST_CASE("Force scaling, limit and the value outside are as chosen",
          "[contact][grasp_wrench_space]") {
  const double mu = 0.5;
  WrenchSpaceOptions options{.friction = mu, .torque_scale = 1.0};
  const auto epsilon = [&](const Contacts& contacts) {
    return epsilon_quality(grasp_wrench_space(contacts, Vector3d::Zero(), options));
  };
  const double unit_normal = epsilon(on_cube());
  options.force_scaling = ForceScaling::UnitEdge;
  CHECK(epsilon(on_cube()) == Approx(unit_normal / std::hypot(1.0, mu)).epsilon(kRounding));
  options.force_limit = 7.0;
  CHECK(epsilon(on_cube()) == Approx(7.0 * unit_normal / std::hypot(1.0, mu)).epsilon(kRounding));

  // Three contacts on one side can only push away from it.
  const Contacts open = on_sphere({{1, 0.3, 0}, {1, -0.3, 0.2}, {1, 0, -0.4}});
  options = {.friction = 0.2, .torque_scale = 1.0};
  CHECK(epsilon(open) == 0.0);
  options.outside = OutsideValue::MinusOne;
  CHECK(epsilon(open) == -1.0);
  options.outside = OutsideValue::Signed;
  CHECK(epsilon(open) < 0.0);
  CHECK(epsilon(on_cube()) > 0.0);

  const WrenchQuality none =
      wrench_quality(grasp_wrench_space({}, Vector3d::Zero(), {.torque_scale = 1.0}));
  CHECK(none.rank == -1);
  CHECK(none.epsilon == 0.0);
  CHECK(none.volume == 0.0);
  CHECK_FALSE(none.is_force_closure);
  CHECK_THROWS_AS(space_of({contact_at(Vector3d::Constant(NAN), Vector3d::UnitX())}, 0.5),
                  InvalidInput);
  CHECK_THROWS_AS(grasp_wrench_space({}, Vector3d::Zero(), WrenchSpaceOptions{}), InvalidInput);
}

}  // namespace test_grasp_wrench_space
