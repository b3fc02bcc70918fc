#include <Eigen/Geometry>
#include <cmath>

#include "contact/known_grasps.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/contact/grasp_matrix_quality.hpp"
#include "support/catch.hpp"

namespace test_grasp_matrix_quality {

using namespace graspfit;
using namespace graspfit::contact;
using Eigen::Vector3d;

namespace {

constexpr double kRounding = 1e-12;

GraspMatrixQuality of(const testing::Contacts& contacts, double torque_scale = 1.0) {
  return grasp_matrix_quality(contacts, Vector3d::Zero(), torque_scale);
}

}  // namespace

// For points p_i on the unit sphere, G Gᵀ has the blocks k I for forces, Σ (I − p_i p_iᵀ) / λ² for
// torques, and Σ [p_i]ₓ / λ between them, which is zero where the points balance.

TEST_CASE("Singular values of contacts on a ball are the known ones",
          "[contact][grasp_matrix_quality]") {
  for (const double scale : {1.0, 0.5, 4.0}) {
    CAPTURE(scale);
    // Six contacts have 6 I and (6 − 2) I / λ².
    const GraspMatrixQuality cube = of(testing::on_cube(), scale);
    const double force = std::sqrt(6.0);
    const double torque = 2.0 / scale;
    CHECK(cube.smallest() == Approx(std::min(force, torque)).epsilon(kRounding));
    CHECK(cube.product() == Approx(std::pow(force * torque, 3)).epsilon(kRounding));
    CHECK(cube.ratio() ==
          Approx(std::min(force, torque) / std::max(force, torque)).epsilon(kRounding));
  }
  // Four contacts have 4 I and (4 − 4/3) I.
  const GraspMatrixQuality tetrahedron = of(testing::on_tetrahedron());
  CHECK(tetrahedron.smallest() == Approx(std::sqrt(8.0 / 3.0)).epsilon(kRounding));
  CHECK(tetrahedron.ratio() == Approx(std::sqrt(2.0 / 3.0)).epsilon(kRounding));
  // Two contacts have no torque about their line.
  const GraspMatrixQuality two = of(testing::antipodal());
  for (int i = 0; i < 5; ++i) {
    CHECK(two.singular_values[i] == Approx(std::sqrt(2.0)).epsilon(kRounding));
  }
  CHECK(two.smallest() == Approx(0.0).margin(1e-15));
}

TEST_CASE("Singular values do not change with the frame, nor with size at its torque scale",
          "[contact][grasp_matrix_quality]") {
  base::Random random(41);
  for (int i = 0; i < 5; ++i) {
    const testing::Contacts contacts = testing::random_contacts(random, 3 + i);
    const Vector3d center(0.1, -0.2, 0.05);
    const GraspMatrixQuality quality = grasp_matrix_quality(contacts, center, 1.3);
    const Eigen::AngleAxisd turn(random.uniform(0.0, 3.0), testing::random_direction(random));
    const Vector3d shift = testing::random_direction(random);
    testing::Contacts moved = contacts;
    for (Contact& contact : moved) {
      contact.point_O = 2.5 * (turn * contact.point_O) + shift;
      contact.inward_normal_O = turn * contact.inward_normal_O;
    }
    const GraspMatrixQuality again =
        grasp_matrix_quality(moved, 2.5 * (turn * center) + shift, 2.5 * 1.3);
    CHECK((again.singular_values - quality.singular_values).norm() < 1e-12);
  }
}

TEST_CASE("Few contacts span fewer directions", "[contact][grasp_matrix_quality]") {
  CHECK(of({}).singular_values.norm() == 0.0);
  CHECK(of({}).ratio() == 0.0);
  const GraspMatrixQuality one = of({testing::on_cube()[0]});
  CHECK(one.singular_values[2] > 0.5);
  CHECK(one.singular_values.tail(3).norm() == 0.0);
  CHECK(one.product() == 0.0);
  CHECK_THROWS_AS(of(testing::on_cube(), 0.0), base::InvalidInput);
}

}  // namespace test_grasp_matrix_quality
