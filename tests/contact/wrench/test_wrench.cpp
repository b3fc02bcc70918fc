#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "contact/random_contacts.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/contact/wrench.hpp"
#include "graspfit/contact/wrench_convention.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

namespace test_wrench {

using namespace graspfit::contact;
using Eigen::Vector3d;
using graspfit::base::InvalidInput;
using graspfit::base::Random;
using graspfit::testing::random_direction;

TEST_CASE("Cone edges lie on the cone, evenly spaced from normal x e_x on", "[contact][wrench]") {
  Random random(71);
  const int num_edges = GENERATE(3, 4, 7, 8, 12);
  const double friction = GENERATE(0.0, 0.3, 2.0);
  for (int i = 0; i < 20; ++i) {
    const Vector3d normal = i == 0 ? Vector3d(Vector3d::UnitX()) : random_direction(random);
    const FrictionCone cone = friction_cone(normal, friction);
    const Vector3d axis = std::abs(normal.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY();
    CHECK((cone.tangent_1_O - normal.cross(axis).normalized()).norm() < 1e-15);
    const Eigen::Matrix3Xd edges = cone_edges(cone, num_edges);
    REQUIRE(edges.cols() == num_edges);
    CHECK((edges.col(0) - normal - friction * cone.tangent_1_O).norm() < 1e-15);
    const Eigen::AngleAxisd turn(2.0 * std::numbers::pi / num_edges, normal);
    for (int k = 0; k < num_edges; ++k) {
      CHECK(edges.col(k).dot(normal) == Approx(1.0).epsilon(1e-14));
      CHECK((edges.col(k) - normal).norm() == Approx(friction).margin(1e-15));
      CHECK((turn * edges.col(k) - edges.col((k + 1) % num_edges)).norm() < 1e-14);
    }
  }
}

TEST_CASE("The edges of an eight-gon around an axis are its mirror images, bit by bit",
          "[contact][wrench]") {
  const Eigen::Matrix3Xd edges = cone_edges(friction_cone(Vector3d::UnitZ(), 0.5), 8);
  for (int k = 0; k < 8; ++k) {
    CHECK(edges(0, k) == -edges(0, (k + 4) % 8));
    CHECK(edges(1, k) == -edges(1, (k + 4) % 8));
    CHECK(std::abs(edges(k % 2 == 0 ? k / 2 % 2 : 0, k)) ==
          (k % 2 == 0 ? 0.0 : 0.5 * (std::numbers::sqrt2 / 2.0)));
  }
}

TEST_CASE("The grasp matrix takes forces in contact frames to the wrench of their sum",
          "[contact][wrench]") {
  Random random(72);
  const std::vector<Contact> contacts = graspfit::testing::random_contacts(random, 4);
  const Vector3d reference(0.3, -0.2, 0.1);
  const double scale = 0.07;
  const Wrenches matrix = grasp_matrix(contacts, reference, scale);
  REQUIRE(matrix.cols() == 12);
  Eigen::VectorXd forces(12);
  Wrench total = Wrench::Zero();
  for (int i = 0; i < 4; ++i) {
    const FrictionCone cone = friction_cone(contacts[i].inward_normal_O, 0.5);
    for (int k = 0; k < 3; ++k) forces[3 * i + k] = random.uniform(-1.0, 1.0);
    const Vector3d force = forces[3 * i] * cone.tangent_1_O + forces[3 * i + 1] * cone.tangent_2_O +
                           forces[3 * i + 2] * cone.inward_normal_O;
    total.head<3>() += force;
    total.tail<3>() += (contacts[i].point_O - reference).cross(force) / scale;
  }
  CHECK((matrix * forces - total).norm() < 1e-12 * total.norm());
}

TEST_CASE("Each tool's convention has its scale, origin and forces", "[contact][wrench]") {
  Random random(73);
  const Vector3d com(0.01, 0.0, 0.02);
  const WrenchObject object{
      .center_of_mass_O = com, .largest_radius = 0.08, .extents_O = {0.06, 0.1, 0.04}};
  std::vector<Contact> contacts(3);
  for (int i = 0; i < 3; ++i) contacts[i].point_O[i] = 0.03;
  const Vector3d centroid = Vector3d::Constant(0.01);
  const double mean_distance = 0.01 * std::sqrt(6.0);  // It is that of (2, −1, −1) cm.
  using enum WrenchTool;
  struct Row {
    WrenchTool tool;
    double scale;
    Vector3d reference;
    ForceScaling scaling;
    OutsideValue outside;
    int num_edges;
  };
  for (const Row& row : {
           Row{Graspfit, 0.08, com, ForceScaling::UnitNormal, OutsideValue::Zero, 8},
           Row{GraspIt, 0.08, com, ForceScaling::UnitNormal, OutsideValue::MinusOne, 8},
           Row{Simox, 0.05, com, ForceScaling::UnitEdge, OutsideValue::Zero, 8},
           Row{DexNet, 0.06, com, ForceScaling::UnitNormal, OutsideValue::Zero, 8},
           Row{Frogger, 1.0, com, ForceScaling::UnitEdge, OutsideValue::Signed, 4},
           Row{DexGraspBench, mean_distance, centroid, ForceScaling::UnitNormal, OutsideValue::Zero,
               8},
       }) {
    const WrenchConvention convention = wrench_convention(row.tool, object, contacts, 0.4);
    CHECK(convention.tool == row.tool);
    CHECK(convention.options.torque_scale.value() == Approx(row.scale).epsilon(1e-14));
    CHECK((convention.reference_point_O - row.reference).norm() < 1e-16);
    CHECK(convention.options.force_scaling == row.scaling);
    CHECK(convention.options.outside == row.outside);
    CHECK(convention.options.num_cone_edges == row.num_edges);
    CHECK(convention.options.friction == 0.4);
  }
  CHECK(describe(wrench_convention(GraspIt, object, {}, 0.4)) ==
        "GraspIt!: torques about (0.01, 0, 0.02) m over 0.08 m, friction 0.4, 8 inscribed edges "
        "from normal x e_x, L1, unit normal force, outside -1");
  CHECK_THROWS_AS(wrench_convention(DexGraspBench, object, {}, 0.4), InvalidInput);
}

TEST_CASE("Cones, scales and options out of range are refused", "[contact][wrench]") {
  CHECK_THROWS_AS(friction_cone(Vector3d::UnitX() * 1.01, 0.5), InvalidInput);
  CHECK_THROWS_AS(friction_cone(Vector3d::UnitX(), -0.1), InvalidInput);
  CHECK_THROWS_AS(cone_edges(friction_cone(Vector3d::UnitX(), 0.5), 2), InvalidInput);
  CHECK_THROWS_AS(grasp_matrix({}, Vector3d::Zero(), 0.0), InvalidInput);
  CHECK_THROWS_WITH(WrenchSpaceOptions{}.validate(),
                    graspfit::testing::Contains("torque_scale = nan"));
  CHECK_NOTHROW(WrenchSpaceOptions{.torque_scale = 1.0}.validate());
  CHECK_THROWS_AS((WrenchSpaceOptions{.num_cone_edges = 2, .torque_scale = 1.0}.validate()),
                  InvalidInput);
  CHECK_THROWS_AS((WrenchSpaceOptions{.friction = -1.0, .torque_scale = 1.0}.validate()),
                  InvalidInput);
  CHECK_THROWS_AS((WrenchSpaceOptions{.torque_scale = 1.0, .force_limit = 0.0}.validate()),
                  InvalidInput);
}

}  // namespace test_wrench
