#include <numbers>

#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

namespace test_mass_properties {

using namespace graspfit::base;
using namespace graspfit::geometry;

TEST_CASE("A box has the mass properties of its formulas wherever it is",
          "[geometry][mass_properties]") {
  TriangleMesh mesh = box({1, 2, 3});
  const Eigen::Vector3d center(100, -50, 7);
  for (auto& vertex : mesh.vertices) vertex += center;
  const MassProperties mass = mass_properties(mesh);
  CHECK(mass.volume == Approx(6.0));
  CHECK((mass.center_of_mass - center).norm() < 1e-13);
  // The moments are m/12 (b² + c²) and so on, with m = 6.
  const Eigen::Matrix3d expected = Eigen::Vector3d(6.5, 5.0, 2.5).asDiagonal();
  CHECK((mass.inertia - expected).norm() < 1e-12);
}

TEST_CASE("A fine ball and torus come near their formulas", "[geometry][mass_properties]") {
  using std::numbers::pi;
  const MassProperties sphere = mass_properties(ball(1.0, 5));
  CHECK(sphere.volume == Approx(4.0 / 3.0 * pi).epsilon(1e-3));
  CHECK((sphere.inertia - 8.0 / 15.0 * pi * Eigen::Matrix3d::Identity()).norm() < 5e-3);
  CHECK(sphere.center_of_mass.norm() < 1e-14);
  // The volume is 2 pi² R r², the moment about its axis m (R² + 3/4 r²).
  const MassProperties ring = mass_properties(torus(1.0, 0.3, 200, 100));
  CHECK(ring.volume == Approx(2 * pi * pi * 0.09).epsilon(1e-3));
  CHECK(ring.inertia(2, 2) == Approx(ring.volume * (1 + 0.75 * 0.09)).epsilon(1e-3));
}

TEST_CASE("Inertia turns with the body", "[geometry][mass_properties]") {
  const RigidTransform X(Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized()));
  const TriangleMesh mesh = box({1, 2, 3});
  const Eigen::Matrix3d R = X.linear();
  CHECK((mass_properties(transformed(mesh, X)).inertia -
         R * mass_properties(mesh).inertia * R.transpose())
            .norm() < 1e-13);
}

TEST_CASE("A hollow body has the difference", "[geometry][mass_properties]") {
  TriangleMesh hollow = concatenated({box({4, 4, 4}), box({2, 2, 2})});
  for (std::size_t face = 12; face < 24; ++face)
    std::swap(hollow.faces[face][1], hollow.faces[face][2]);
  CHECK(mass_properties(hollow).volume == Approx(56.0));
}

TEST_CASE("Parts that overlap count once, and the method says so", "[geometry][mass_properties]") {
  const TriangleMesh cube = box({2, 2, 2});
  TriangleMesh beside = cube;
  for (auto& vertex : beside.vertices) vertex += Eigen::Vector3d(1, 0, 0);
  // The two cubes overlap and form a bar of 3 x 2 x 2.
  const MassProperties bar = mass_properties(concatenated({cube, beside}));
  CHECK(bar.method == MassMethod::SolidBoundary);
  CHECK(bar.volume == Approx(12.0));
  CHECK((bar.center_of_mass - Eigen::Vector3d(0.5, 0, 0)).norm() < 1e-13);
  const Eigen::Matrix3d expected = Eigen::Vector3d(8, 13, 13).asDiagonal();
  CHECK((bar.inertia - expected).norm() < 1e-12);

  CHECK(mass_properties(concatenated({ball(1, 3), ball(0.5, 3)})).volume ==
        Approx(signed_volume(ball(1, 3))));
  for (auto& vertex : beside.vertices) vertex += Eigen::Vector3d(5, 0, 0);
  const MassProperties apart = mass_properties(concatenated({cube, beside}));
  CHECK(apart.method == MassMethod::SignedSum);
  CHECK(apart.volume == Approx(16.0));
  CHECK(mass_properties(cube).method == MassMethod::SignedSum);
  // Open parts bound no solid and are summed as they are.
  TriangleMesh open = concatenated({cube, cube});
  open.faces.pop_back();
  CHECK(mass_properties(open).method == MassMethod::SignedSum);
}

TEST_CASE("Without volume there are no mass properties", "[geometry][mass_properties]") {
  TriangleMesh inward = box({1, 1, 1});
  for (Face& f : inward.faces) std::swap(f[1], f[2]);
  CHECK(signed_volume(inward) == Approx(-1.0));
  CHECK_THROWS_AS(mass_properties(inward), DegenerateGeometry);
  CHECK(signed_volume(TriangleMesh{}) == 0.0);
  CHECK_THROWS_AS(mass_properties(TriangleMesh{}), DegenerateGeometry);
}

TEST_CASE("The largest radius is that of the farthest vertex", "[geometry][mass_properties]") {
  CHECK(largest_radius(box({2, 4, 4}), {0, 0, 0}) == Approx(3.0));
  CHECK(largest_radius(TriangleMesh{}, {0, 0, 0}) == 0.0);
}

}  // namespace test_mass_properties
