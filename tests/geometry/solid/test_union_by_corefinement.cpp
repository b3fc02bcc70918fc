#include <algorithm>

#include "geometry/changed_meshes.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/solid_boundary.hpp"
#include "solid/crossing_faces.hpp"
#include "solid/mesh_operations.hpp"
#include "solid/union_by_corefinement.hpp"
#include "support/catch.hpp"

namespace test_union_by_corefinement {

using namespace graspfit::base;
using namespace graspfit::geometry;
using Eigen::Vector3d;
using graspfit::testing::inward;
using graspfit::testing::moved;

namespace {

std::optional<TriangleMesh> united(const std::vector<TriangleMesh>& parts) {
  TriangleMesh mesh = concatenated(parts);
  internal::weld(mesh, 0.0);
  return internal::union_by_corefinement(mesh, internal::crossing_faces(mesh));
}

/// Boxes and balls turned at random through each other, one nested in all and one apart.
std::vector<TriangleMesh> parts_anyhow(Random& random, int count) {
  std::vector<TriangleMesh> parts;
  for (int i = 0; i < count; ++i) {
    const Vector3d axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const RigidTransform X(Eigen::AngleAxisd(random.uniform(0, 3), axis.normalized()));
    parts.push_back(
        moved(transformed(i % 2 == 0 ? ball(0.6, 2) : box({1, 0.7, 0.5}), X), 0.3 * axis));
  }
  parts.push_back(box({0.01, 0.02, 0.03}));
  parts.push_back(moved(box({0.1, 0.1, 0.1}), {3, 0, 0}));
  return parts;
}

}  // namespace

TEST_CASE("Clean parts that cross are united by corefinement: inside is what is inside one of them",
          "[geometry][solid_boundary]") {
  Random random(5);
  for (const int count : {2, 3, 5}) {
    CAPTURE(count);
    const std::vector<TriangleMesh> parts = parts_anyhow(random, count);
    const std::optional<TriangleMesh> mesh = united(parts);
    REQUIRE(mesh);
    const MeshAnalysis analysis = analyze(*mesh);
    CHECK(analysis.num_boundary_edges == 0);
    CHECK(analysis.num_nonmanifold_edges == 0);
    const MeshQuery together(*mesh);
    std::vector<MeshQuery> alone;
    for (const TriangleMesh& part : parts) alone.emplace_back(part);
    int num_inside = 0;
    for (int i = 0; i < 1000; ++i) {
      const Vector3d p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const bool is_inside = std::any_of(alone.begin(), alone.end(), [&](const MeshQuery& part) {
        return part.containment(p) == Containment::Inside;
      });
      REQUIRE((together.containment(p) == Containment::Inside) == is_inside);
      num_inside += is_inside;
    }
    CHECK(num_inside > 100);

    // Two boxes that touch at a corner, far away, keep corefinement off: then solid_boundary cuts
    // by itself.
    std::vector<TriangleMesh> with_touch = parts;
    with_touch.push_back(moved(box({2, 2, 2}), {9, 0, 0}));
    with_touch.push_back(moved(box({2, 2, 2}), {11, 2, 2}));
    REQUIRE_FALSE(united(with_touch));
    const TriangleMesh cut = solid_boundary(concatenated(with_touch));
    CHECK(signed_volume(cut) - 16.0 == Approx(signed_volume(*mesh)).epsilon(1e-12));
    CHECK(surface_area(cut) - 48.0 == Approx(surface_area(*mesh)).epsilon(1e-12));
  }
}

TEST_CASE("Faces that cross nothing come first and as they were, vertices keep their places",
          "[geometry][solid_boundary]") {
  const std::vector<TriangleMesh> parts = {ball(1, 2), moved(ball(1, 2), {1.5, 0.1, 0.2})};
  const TriangleMesh mesh = concatenated(parts);
  const std::optional<TriangleMesh> both = united(parts);
  REQUIRE(both);
  CHECK(std::equal(mesh.vertices.begin(), mesh.vertices.end(), both->vertices.begin()));
  std::vector<bool> crosses(mesh.faces.size(), false);
  for (const auto& [a, b] : internal::crossing_faces(mesh)) crosses[a] = crosses[b] = true;
  const MeshQuery first(parts[0]);
  const MeshQuery second(parts[1]);
  std::vector<Face> expected;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const MeshQuery& other = i < parts[0].faces.size() ? second : first;
    const Vector3d corner = mesh.vertices[static_cast<std::size_t>(mesh.faces[i][0])];
    if (!crosses[i] && other.containment(corner) == Containment::Outside) {
      expected.push_back(mesh.faces[i]);
    }
  }
  REQUIRE(expected.size() > 100);
  REQUIRE(both->faces.size() > expected.size());
  CHECK(std::equal(expected.begin(), expected.end(), both->faces.begin()));
}

TEST_CASE("What is not clean, or touches, is not for corefinement", "[geometry][solid_boundary]") {
  const TriangleMesh cube = box({2, 2, 2});
  const TriangleMesh spike = moved(cube, {1, 0.5, 0.25});
  CHECK(united({cube, spike}));
  CHECK_FALSE(united({cube}));
  CHECK_FALSE(united({cube, moved(cube, {5, 0, 0})}));  // apart
  CHECK_FALSE(united({cube, box({1, 1, 1})}));          // nested
  CHECK_FALSE(united({cube, moved(cube, {1, 0, 0})}));  // in common planes
  CHECK_FALSE(united({cube, moved(cube, {2, 0, 0})}));  // side to side
  CHECK_FALSE(united({cube, moved(cube, {2, 2, 2})}));  // corner to corner
  CHECK_FALSE(united({cube, spike, moved(cube, {2, 5, 5}), moved(cube, {4, 7, 7})}));
  CHECK_FALSE(united({cube, inward(spike)}));
  CHECK_FALSE(united({cube, spike, inward(spike)}));
  TriangleMesh open = concatenated({cube, spike});
  open.faces.pop_back();
  CHECK_FALSE(internal::union_by_corefinement(open, internal::crossing_faces(open)));
  // The corner of a turned cube on a side of another that it also crosses elsewhere.
  const RigidTransform turned(Eigen::AngleAxisd(0.5, Vector3d(1, 2, 3).normalized()));
  const TriangleMesh other = transformed(cube, turned);
  Vector3d top = other.vertices[0];
  for (const Vector3d& p : other.vertices) top = p.z() > top.z() ? p : top;
  // A sum of doubles need not be the plane: the cube's side is set to the corner instead.
  TriangleMesh lower = cube;
  for (Vector3d& p : lower.vertices) p.z() = p.z() > 0.0 ? top.z() : top.z() - 1.0;
  CHECK_FALSE(united({lower, other}));
}

}  // namespace test_union_by_corefinement
