#include <algorithm>
#include <cmath>
#include <vector>

#include "contact/random_contacts.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/contact/grasp_balance.hpp"
#include "support/catch.hpp"

namespace test_grasp_balance {

using namespace graspfit::contact;
using Eigen::Vector3d;
using graspfit::base::InvalidInput;
using graspfit::base::Random;
using graspfit::testing::contact_at;
using graspfit::testing::random_contacts;
using Contacts = std::vector<Contact>;

namespace {

Wrench load_of(const Vector3d& force) {
  Wrench load = Wrench::Zero();
  load.head<3>() = force;
  return load;
}

/// Checks the conditions of Karush, Kuhn and Tucker. The problem is convex, so that they make an
/// optimum. With r the residual and the multiplier λ ≥ 0 of the bound, every edge has w · r ≥ λ,
/// those with force equality, and λ = 0 unless the bound is met with equality.
void check_optimal(const Contacts& contacts, const Vector3d& reference, const Wrench& load,
                   const BalanceOptions& options, const BalanceForces& found) {
  Wrench total = Wrench::Zero();
  double normal_sum = 0.0;
  double least = 1e300;   // of w · r
  double on_force = 0.0;  // Σ α (w · r)
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const FrictionCone cone = friction_cone(contacts[i].inward_normal_O, options.friction);
    const Eigen::Matrix3Xd edges = cone_edges(cone, options.num_cone_edges);
    Vector3d force = Vector3d::Zero();
    for (Eigen::Index k = 0; k < edges.cols(); ++k) {
      const double share =
          found.edge_forces[static_cast<Eigen::Index>(i) * options.num_cone_edges + k];
      CHECK(share >= 0.0);
      const Wrench w =
          wrench(edges.col(k), contacts[i].point_O, reference, options.torque_scale.value());
      least = std::min(least, w.dot(found.residual));
      on_force += share * w.dot(found.residual);
      force += share * edges.col(k);
      normal_sum += share;
    }
    CHECK((force - found.forces_O.col(static_cast<Eigen::Index>(i))).norm() < 1e-10);
    total += wrench(force, contacts[i].point_O, reference, options.torque_scale.value());
  }
  const double size = 1.0 + load.norm() + options.least_normal_sum;
  CHECK((total - load - found.residual).norm() < 1e-11 * size);
  CHECK(found.residual.norm() == Approx(found.residual_norm));
  CHECK(normal_sum == Approx(found.normal_sum).margin(1e-12));
  CHECK(normal_sum >= options.least_normal_sum * (1.0 - 1e-12));
  const bool is_bound_active = normal_sum <= options.least_normal_sum * (1.0 + 1e-9);
  const double multiplier = is_bound_active ? std::max(0.0, least) : 0.0;
  CHECK(least >= multiplier - 1e-10 * size);
  CHECK(std::abs(on_force - multiplier * normal_sum) <= 1e-9 * size * size);
}

}  // namespace

TEST_CASE("A single contact can push but not pull", "[contact][grasp_balance]") {
  const Contacts contacts = {contact_at(Vector3d::Zero(), Vector3d::UnitZ())};
  BalanceOptions options{.friction = 0.0, .torque_scale = 1.0};
  const auto balance = [&](double push) {
    return balance_forces(contacts, Vector3d::Zero(), load_of({0, 0, push}), options);
  };
  CHECK(balance(4.0).residual_norm < 1e-14);
  CHECK((balance(4.0).forces_O.col(0) - Vector3d(0, 0, 4)).norm() < 1e-14);
  CHECK(balance(-5.0).residual_norm == Approx(5.0));
  CHECK(balance(-5.0).normal_sum == 0.0);
  options.least_normal_sum = 3.0;  // It has to push 3 N, against the load.
  CHECK(balance(-5.0).residual_norm == Approx(8.0));
  CHECK(balance(-5.0).normal_sum == Approx(3.0));
  CHECK(balance(4.0).residual_norm < 1e-14);  // It pushes enough by itself.
}

TEST_CASE("Two fingers hold a weight by friction if they squeeze enough",
          "[contact][grasp_balance]") {
  const double mu = 0.5;
  const double weight = 6.0;
  const Contacts contacts = {contact_at({1, 0, 0}, -Vector3d::UnitX()),
                             contact_at({-1, 0, 0}, Vector3d::UnitX())};
  BalanceOptions options{.num_cone_edges = 4, .friction = mu, .torque_scale = 1.0};
  const BalanceForces holding =
      balance_forces(contacts, Vector3d::Zero(), load_of({0, 0, weight}), options);
  CHECK(holding.residual_norm < 1e-13);
  CHECK(holding.normal_sum >= weight / mu - 1e-12);  // Each takes half of it, at μ N.
  CHECK(holding.forces_O(2, 0) == Approx(3.0));
  CHECK(holding.forces_O(2, 1) == Approx(3.0));
  // More squeeze than that does no harm, and a torque about their line cannot be held at all.
  options.least_normal_sum = 40.0;
  CHECK(balance_forces(contacts, Vector3d::Zero(), load_of({0, 0, weight}), options).residual_norm <
        1e-12);
  Wrench twist = Wrench::Zero();
  twist[3] = 2.0;
  CHECK(balance_forces(contacts, Vector3d::Zero(), twist, options).residual_norm ==
        Approx(2.0).epsilon(1e-12));
}

TEST_CASE("Balance forces meet the conditions of an optimum", "[contact][grasp_balance]") {
  Random random(91);
  int num_active = 0;
  int num_balanced = 0;
  for (int i = 0; i < 60; ++i) {
    const Contacts contacts = random_contacts(random, 1 + i % 5);
    const Vector3d reference(0.1, 0.0, -0.1);
    Wrench load;
    for (double& x : load) x = i % 7 == 0 ? 0.0 : random.uniform(-2.0, 2.0);
    const BalanceOptions options{.num_cone_edges = 3 + i % 6,
                                 .friction = random.uniform(0.0, 1.0),
                                 .least_normal_sum = i % 3 * 4.0,
                                 .torque_scale = 0.8};
    const BalanceForces found = balance_forces(contacts, reference, load, options);
    check_optimal(contacts, reference, load, options, found);
    num_active += options.least_normal_sum > 0.0 &&
                  found.normal_sum < options.least_normal_sum * (1.0 + 1e-9);
    num_balanced += found.residual_norm < 1e-9;
  }
  CHECK(num_active > 10);
  CHECK(num_balanced > 5);
}

TEST_CASE("Even forces are those of no other balance by much, and alike where contacts are",
          "[contact][grasp_balance]") {
  Random random(77);
  BalanceOptions options{.friction = 0.6, .least_normal_sum = 6.0, .torque_scale = 0.9};
  for (int i = 0; i < 30; ++i) {
    const Contacts contacts = random_contacts(random, 2 + i % 4);
    const Wrench load = i % 2 == 0 ? Wrench(Wrench::Zero()) : load_of({0.3, -0.2, 0.5});
    options.evenness = 0.0;
    const BalanceForces least = balance_forces(contacts, Vector3d::Zero(), load, options);
    options.evenness = 1e-3;
    const BalanceForces even = balance_forces(contacts, Vector3d::Zero(), load, options);
    CHECK(even.residual_norm >= least.residual_norm - 1e-9);
    CHECK(even.residual_norm <= least.residual_norm + 1e-3 * least.normal_sum);
    CHECK(even.edge_forces.norm() <= least.edge_forces.norm() * (1.0 + 1e-9));
    CHECK(even.normal_sum >= 6.0 * (1.0 - 1e-12));
  }
  // On the six sides of a cube each contact takes a sixth of the force, straight in, though two
  // would do.
  Contacts cube;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      cube.push_back(contact_at(side * Vector3d::Unit(axis), -side * Vector3d::Unit(axis)));
    }
  }
  const BalanceForces even = balance_forces(cube, Vector3d::Zero(), Wrench::Zero(), options);
  for (std::size_t i = 0; i < cube.size(); ++i) {
    CHECK((even.forces_O.col(static_cast<Eigen::Index>(i)) - cube[i].inward_normal_O).norm() <
          1e-6);
  }
}

TEST_CASE("Balances without contacts or sense have documented outcomes",
          "[contact][grasp_balance]") {
  const Wrench load = load_of({1, 2, 2});
  const BalanceOptions options{.torque_scale = 1.0};
  const BalanceForces none = balance_forces({}, Vector3d::Zero(), load, options);
  CHECK(none.forces_O.cols() == 0);
  CHECK(none.residual_norm == Approx(3.0));
  CHECK_THROWS_WITH(balance_forces({}, Vector3d::Zero(), load, BalanceOptions{}),
                    graspfit::testing::Contains("torque_scale = nan, must be set"));
  CHECK_THROWS_AS(
      balance_forces({}, Vector3d::Zero(), load, {.least_normal_sum = 1.0, .torque_scale = 1.0}),
      InvalidInput);
  CHECK_THROWS_AS(balance_forces({}, Vector3d::Zero(), Wrench::Constant(NAN), options),
                  InvalidInput);
  CHECK_THROWS_AS(
      balance_forces({}, Vector3d::Zero(), load, {.num_cone_edges = 2, .torque_scale = 1.0}),
      InvalidInput);
}

}  // namespace test_grasp_balance
