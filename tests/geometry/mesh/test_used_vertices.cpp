#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/used_vertices.hpp"
#include "support/catch.hpp"

namespace test_used_vertices {

using namespace graspfit::geometry;
using Eigen::Vector3d;

TEST_CASE("Vertices of no face are not used", "[geometry][used_vertices]") {
  TriangleMesh mesh;
  mesh.vertices = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {7, 7, 7}, {0, 1, 0}};
  mesh.faces = {{1, 2, 4}, {1, 4, 2}};
  const std::vector<Vector3d> used = used_vertices(mesh);
  REQUIRE(used.size() == 3);
  CHECK(used[0] == Vector3d(0, 0, 0));
  CHECK(used[2] == Vector3d(0, 1, 0));
  CHECK(used_vertices(box({1, 2, 3})).size() == 8);
  CHECK(used_vertices({}).empty());
}

}  // namespace test_used_vertices
