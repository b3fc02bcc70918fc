#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "graspfit/base/random.hpp"
#include "graspfit/geometry/rigid_transform.hpp"
#include "support/catch.hpp"

namespace test_rigid_transform {

using namespace graspfit::geometry;
using Eigen::AngleAxisd;
using Eigen::Vector3d;
using graspfit::base::Random;

namespace {

Vector3d random_vector(Random& random) {
  const double x = random.uniform(-1.0, 1.0);
  const double y = random.uniform(-1.0, 1.0);
  return {x, y, random.uniform(-1.0, 1.0)};
}

RigidTransform random_pose(Random& random) {
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() =
      AngleAxisd(random.uniform(0.0, 3.0), random_vector(random).normalized()).toRotationMatrix();
  pose.translation() = random_vector(random);
  return pose;
}

RigidTransform turned(double angle, const Vector3d& axis) {
  return RigidTransform(AngleAxisd(angle, axis));
}

using Quaternion = std::array<double, 4>;

/// Checks four numbers to rounding: each is a sine, a cosine or a root away from the matrix.
void check_same(const Quaternion& found, const Quaternion& expected) {
  for (int i = 0; i < 4; ++i) {
    CAPTURE(i, found[i], expected[i]);
    CHECK(std::abs(found[i] - expected[i]) < 1e-15);
  }
}

}  // namespace

TEST_CASE("Poses written with few digits are inverted as they are", "[geometry][rigid_transform]") {
  Random random(7);
  for (int trial = 0; trial < 50; ++trial) {
    const RigidTransform X_OA = random_pose(random);
    const RigidTransform X_OB = random_pose(random);
    REQUIRE(is_rotation(X_OA));
    // Of rotations it is the transpose, to the last bit.
    CHECK(inverted(X_OA).matrix() == X_OA.inverse().matrix());
    CHECK(relative_pose(X_OA, X_OB).matrix() == (X_OA.inverse() * X_OB).matrix());
    // With six digits the transpose is no inverse.
    RigidTransform written = X_OA;
    written.linear() = (1e6 * X_OA.linear()).array().round().matrix() / 1e6;
    if (is_rotation(written)) continue;
    CHECK((written * relative_pose(written, X_OB)).matrix().isApprox(X_OB.matrix(), 1e-14));
    CHECK((inverted(written) * written).matrix().isIdentity(1e-14));
    CHECK_FALSE((written.inverse() * written).matrix().isIdentity(1e-9));
  }
}

TEST_CASE("Of the two quaternions of a rotation one is stated, without negative zeros",
          "[geometry][rigid_transform]") {
  check_same(rotation_wxyz(RigidTransform::Identity()), {1, 0, 0, 0});
  // By 200° about x the scalar of the half angle is negative: it is a turn by 160° the other way.
  const double half = 80.0 * std::numbers::pi / 180.0;
  check_same(rotation_wxyz(turned(200.0 * std::numbers::pi / 180.0, Vector3d::UnitX())),
             {std::cos(half), -std::sin(half), 0, 0});
  // A half turn about (-0.6, 0.8, 0) is one about its negative. Its matrix is 2 n nᵀ - 1.
  const Vector3d n(-0.6, 0.8, 0.0);
  RigidTransform half_turn = RigidTransform::Identity();
  half_turn.linear() = 2.0 * n * n.transpose() - Eigen::Matrix3d::Identity();
  const Quaternion of_half_turn = rotation_wxyz(half_turn);
  check_same(of_half_turn, {0, 0.6, -0.8, 0});
  CHECK_FALSE(std::signbit(of_half_turn[0]));
  CHECK_FALSE(std::signbit(of_half_turn[3]));
}

TEST_CASE("A pose comes back from its translation and its quaternion",
          "[geometry][rigid_transform]") {
  Random random(11);
  for (int trial = 0; trial < 50; ++trial) {
    const RigidTransform X_AB = random_pose(random);
    const Quaternion wxyz = rotation_wxyz(X_AB);
    const RigidTransform again = rigid_transform(X_AB.translation(), wxyz);
    CHECK(again.translation() == X_AB.translation());
    CHECK((again.linear() - X_AB.linear()).norm() < 1e-14);
    CHECK(is_rotation(again));
    // A quaternion of any length is the rotation of the unit one.
    const Quaternion twice = {2 * wxyz[0], 2 * wxyz[1], 2 * wxyz[2], 2 * wxyz[3]};
    CHECK((rigid_transform(X_AB.translation(), twice).matrix() - again.matrix()).norm() < 1e-14);
  }
  CHECK(rigid_transform({1, 2, 3}, {0, 0, 0, 0}).linear() == Eigen::Matrix3d::Identity());
}

}  // namespace test_rigid_transform
