#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"
#include "support/catch.hpp"

namespace test_triangle_mesh {

using namespace graspfit::base;
using namespace graspfit::geometry;

TEST_CASE("Areas and normals of a box point outward", "[geometry][triangle_mesh]") {
  const TriangleMesh mesh = box({1, 2, 3});
  CHECK(surface_area(mesh) == Approx(22.0));
  Eigen::Vector3d total = Eigen::Vector3d::Zero();
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const auto [a, b, c] = corners(mesh, face);
    CHECK(face_normal(mesh, face).dot(a + b + c) > 0.0);
    CHECK(face_normal(mesh, face).norm() == Approx(1.0));
    total += vector_area(mesh, face);
  }
  CHECK(total.norm() < 1e-15);
}

TEST_CASE("A degenerate face has no area and the zero normal", "[geometry][triangle_mesh]") {
  TriangleMesh mesh;
  mesh.vertices = {{1, 1, 1}, {2, 2, 2}};
  mesh.faces = {{0, 1, 1}};
  CHECK(vector_area(mesh, 0) == Eigen::Vector3d::Zero());
  CHECK(face_normal(mesh, 0) == Eigen::Vector3d::Zero());
}

TEST_CASE("Small faces have unit normals too", "[geometry][triangle_mesh]") {
  const TriangleMesh mesh = scaled(box({1, 1, 1}), 1e-120);
  CHECK(face_normal(mesh, 0) == Eigen::Vector3d(0, 0, -1));
}

TEST_CASE("Extents of boxes, and of a mesh without vertices", "[geometry][triangle_mesh]") {
  CHECK(longest_extent(box({1, 5, 3})) == 5.0);
  CHECK(longest_extent(TriangleMesh{}) == 0.0);
  CHECK(bounding_box(TriangleMesh{}).isEmpty());
  CHECK(surface_area(TriangleMesh{}) == 0.0);
}

TEST_CASE("Moving, scaling and joining meshes", "[geometry][triangle_mesh]") {
  const TriangleMesh mesh = box({1, 1, 1});
  RigidTransform X(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()));
  X.translation() = Eigen::Vector3d(1, 2, 3);
  const TriangleMesh moved = transformed(mesh, X);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    CHECK(moved.vertices[i] == X * mesh.vertices[i]);
  }
  CHECK(surface_area(moved) == Approx(6.0));
  CHECK(surface_area(scaled(mesh, 2.0)) == Approx(24.0));
  CHECK_THROWS_WITH(scaled(mesh, 0.0), graspfit::testing::StartsWith("scaled: factor is 0"));
  CHECK_THROWS_AS(scaled(mesh, -1.0), InvalidInput);

  const TriangleMesh both = concatenated({mesh, moved});
  CHECK(both.vertices.size() == 16);
  CHECK(both.faces.size() == 24);
  CHECK(both.faces[12][0] == mesh.faces[0][0] + 8);
  CHECK(concatenated({}) == TriangleMesh{});
}

}  // namespace test_triangle_mesh
