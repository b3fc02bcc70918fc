#include <Eigen/Geometry>
#include <algorithm>

#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/surface_proximity.hpp"
#include "support/catch.hpp"

namespace test_surface_clearance {

using namespace graspfit::base;
using namespace graspfit::geometry;
using Eigen::Vector3d;

TEST_CASE("Surface clearance bounds the distance from below, as near as asked",
          "[geometry][surface_clearance]") {
  const MeshQuery a(torus(0.05, 0.02, 24, 12));
  const MeshQuery b(box({0.02, 0.03, 0.08}));
  Random random(12);
  int num_crossing = 0;
  int num_apart = 0;
  for (int i = 0; i < 60; ++i) {
    RigidTransform X = RigidTransform::Identity();
    X.linear() = Eigen::Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1),
                                    random.uniform(-1, 1), random.uniform(-1, 1))
                     .normalized()
                     .toRotationMatrix();
    for (double& x : X.translation()) x = random.uniform(-0.12, 0.12);
    const double distance = graspfit::geometry::distance(a, b, X).distance;
    (distance > 0.0 ? num_apart : num_crossing) += 1;
    for (const double enough : {1.0, 0.02, 1e-4}) {
      for (const double share : {0.5, 0.8, 1.0}) {
        const double bound = surface_clearance(a, b, X, enough, share).at_least;
        CHECK(bound <= std::min(distance, enough) + 1e-13);
        CHECK(bound >= std::min(share * distance, enough) - 1e-13);
      }
    }
  }
  CHECK(num_crossing > 5);
  CHECK(num_apart > 5);
}

TEST_CASE("Surface clearance is zero where edges pass through faces far from corners",
          "[geometry][surface_clearance]") {
  // A long thin bar goes through the middle of a large plate: no corner and no two edges are near.
  const MeshQuery plate(box({1.0, 1.0, 0.01}));
  const MeshQuery bar(box({0.01, 0.01, 1.0}));
  RigidTransform X = RigidTransform::Identity();
  X.translation() = Vector3d(0.11, -0.2, 0.0);
  CHECK(surface_clearance(plate, bar, X, 1.0, 1.0).at_least == 0.0);
  CHECK(surface_clearance(bar, plate, X.inverse(), 1.0, 1.0).at_least == 0.0);
  // Beside the plate the bar is as far as its side is: 0.1 m less half its width.
  X.translation() = Vector3d(0.6, 0.0, 0.0);
  CHECK(surface_clearance(plate, bar, X, 1.0, 1.0).at_least == Approx(0.095).epsilon(1e-12));
  // What is inside without a crossing is as far from the surface as it is.
  const MeshQuery inner(box({0.1, 0.1, 0.1}));
  const MeshQuery outer(box({1.0, 1.0, 1.0}));
  CHECK(surface_clearance(outer, inner, RigidTransform::Identity(), 1.0, 1.0).at_least ==
        Approx(0.45));
}

}  // namespace test_surface_clearance
