#include <Eigen/Geometry>

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

}  // namespace test_rigid_transform
