#include <cmath>
#include <numbers>

#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

namespace test_shapes {

using namespace graspfit::base;
using namespace graspfit::geometry;

namespace {

void check_is_closed_and_outward(const TriangleMesh& mesh) {
  const MeshAnalysis analysis = analyze(mesh);
  CHECK(analysis.is_closed);
  CHECK(analysis.is_manifold);
  CHECK(analysis.is_outward);
  CHECK(analysis.num_degenerate_faces == 0);
  CHECK(analysis.num_unused_vertices == 0);
}

}  // namespace

TEST_CASE("Vertices of a ball lie on its sphere", "[geometry][shapes]") {
  for (int subdivisions = 0; subdivisions <= 3; ++subdivisions) {
    const TriangleMesh mesh = ball(0.3, subdivisions);
    CHECK(mesh.faces.size() == std::size_t(20) << (2 * subdivisions));
    for (const auto& vertex : mesh.vertices) CHECK(vertex.norm() == Approx(0.3));
    check_is_closed_and_outward(mesh);
  }
}

TEST_CASE("Vertices of a torus lie on its surface", "[geometry][shapes]") {
  const TriangleMesh mesh = torus(0.3, 0.1, 12, 8);
  CHECK(mesh.faces.size() == 2 * 12 * 8);
  for (const auto& p : mesh.vertices) {
    CHECK(std::hypot(std::hypot(p[0], p[1]) - 0.3, p[2]) == Approx(0.1));
  }
  check_is_closed_and_outward(mesh);
}

TEST_CASE("Box, cylinder and capsule have their extents", "[geometry][shapes]") {
  CHECK(bounding_box(box({1, 2, 3})).sizes() == Eigen::Vector3d(1, 2, 3));
  CHECK(bounding_box(cylinder(1, 3, 96)).sizes().isApprox(Eigen::Vector3d(2, 2, 3)));
  CHECK(bounding_box(capsule(1, 3, 48)).sizes().isApprox(Eigen::Vector3d(2, 2, 5)));
  check_is_closed_and_outward(box({1, 2, 3}));
  check_is_closed_and_outward(cylinder(1, 3, 5));
  check_is_closed_and_outward(capsule(1, 3, 7));
  // The inscribed prism has pi r² h times sin(x)/x of the segment's angle x.
  const double angle = 2 * std::numbers::pi / 96;
  CHECK(signed_volume(cylinder(1, 3, 96)) ==
        Approx(3 * std::numbers::pi * std::sin(angle) / angle));
}

TEST_CASE("A solid of revolution is outward whichever way its profile runs", "[geometry][shapes]") {
  const std::vector<Eigen::Vector2d> up = {{0, -1}, {1, -1}, {0.5, 0}, {1, 1}, {0, 1}};
  const std::vector<Eigen::Vector2d> down(up.rbegin(), up.rend());
  check_is_closed_and_outward(solid_of_revolution(up, 12));
  check_is_closed_and_outward(solid_of_revolution(down, 12));
  CHECK(signed_volume(solid_of_revolution(up, 12)) ==
        Approx(signed_volume(solid_of_revolution(down, 12))));
}

TEST_CASE("Impossible shapes are refused with the name of the number", "[geometry][shapes]") {
  CHECK_THROWS_WITH(ball(0.0), "ball: radius is 0, must be positive");
  CHECK_THROWS_WITH(ball(1.0, 9), "ball: subdivisions is 9, must be in [0, 8]");
  CHECK_THROWS_AS(ball(std::nan("")), InvalidInput);
  CHECK_THROWS_AS(box({1, -1, 1}), InvalidInput);
  CHECK_THROWS_WITH(torus(1, 2), graspfit::testing::Contains("must exceed minor_radius"));
  CHECK_THROWS_AS(torus(2, 1, 2, 8), InvalidInput);
  CHECK_THROWS_AS(cylinder(1, 0), InvalidInput);
  CHECK_THROWS_AS(capsule(1, 1, 3), InvalidInput);
  CHECK_THROWS_AS(solid_of_revolution({{0, 0}, {0, 1}}), InvalidInput);
  CHECK_THROWS_AS(solid_of_revolution({{0, 0}, {1, 0}, {1, 1}}), InvalidInput);
  CHECK_THROWS_AS(solid_of_revolution({{0, 0}, {0, 0.5}, {0, 1}}), InvalidInput);
}

}  // namespace test_shapes
