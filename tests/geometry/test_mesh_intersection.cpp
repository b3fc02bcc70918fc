#include <cmath>

#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

using namespace graspfit::geometry;

namespace {

RigidTransform shift(double x, double y, double z) {
  RigidTransform X = RigidTransform::Identity();
  X.translation() = Eigen::Vector3d(x, y, z);
  return X;
}

RigidTransform drawn_pose(Random& random, double size) {
  Eigen::Vector4d q;
  for (double& x : q) x = random.uniform(-1.0, 1.0);
  RigidTransform X(Eigen::Quaterniond(q).normalized());
  for (double& x : X.translation()) x = random.uniform(-size, size);
  return X;
}

TriangleMesh hollow_box() {
  TriangleMesh mesh = concatenated({box({4, 4, 4}), box({3, 3, 3})});
  for (std::size_t face = 12; face < 24; ++face)
    std::swap(mesh.faces[face][1], mesh.faces[face][2]);
  return mesh;
}

}  // namespace

TEST_CASE("Boxes touch, overlap and miss exactly", "[geometry][mesh_intersection]") {
  const MeshQuery cube(box({2, 2, 2}));
  CHECK(do_intersect(cube, cube, RigidTransform::Identity()));
  CHECK(do_intersect(cube, cube, shift(1.5, 0.5, 0.25)));
  // Face on face, edge on edge, corner on corner; then apart by one ulp of 2.
  for (const auto& [x, y, z] : {std::array{2.0, 0.0, 0.0}, {2.0, 2.0, 0.0}, {2.0, 2.0, 2.0}}) {
    CHECK(do_intersect(cube, cube, shift(x, y, z)));
    CHECK_FALSE(do_intersect(cube, cube, shift(std::nextafter(x, 3.0) + 0x1p-52, y, z)));
  }
}

TEST_CASE("A solid inside another intersects it, one inside its cavity does not",
          "[geometry][mesh_intersection]") {
  const MeshQuery large(box({4, 4, 4}));
  const MeshQuery small(box({1, 1, 1}));
  const MeshQuery hollow(hollow_box());
  CHECK(do_intersect(large, small, shift(0.5, 0, 0)));
  CHECK(do_intersect(small, large, shift(0.5, 0, 0)));
  CHECK_FALSE(do_intersect(hollow, small, shift(0.5, 0, 0)));
  CHECK_FALSE(do_intersect(small, hollow, shift(0.5, 0, 0)));
  CHECK(do_intersect(hollow, small, shift(1.2, 0, 0)));
}

TEST_CASE("Whether balls intersect is told by their distance", "[geometry][mesh_intersection]") {
  const MeshQuery a(ball(1.0, 3));
  const MeshQuery b(ball(0.5, 3));
  Random random(41);
  for (int i = 0; i < 100; ++i) {
    const RigidTransform X = drawn_pose(random, 1.3);
    const double apart = X.translation().norm();
    // The polyhedra lie up to 1 % inside their balls.
    if (apart > 1.485 && apart < 1.5) continue;
    const bool expected = apart < 1.5;
    CHECK(do_intersect(a, b, X) == expected);
    CHECK(do_intersect(b, a, X.inverse()) == expected);
    CHECK(penetration(a, b, X).intersects == expected);
    CHECK((distance(a, b, X).distance == 0.0) == expected);
  }
}

TEST_CASE("Intersection agrees with a test of all pairs of vertices and faces",
          "[geometry][mesh_intersection]") {
  // Convex bodies: they intersect iff a vertex of one is inside the other or an edge of one meets a
  // face of the other; rays of the query decide the latter.
  const TriangleMesh mesh_a = box({1, 2, 3});
  const TriangleMesh mesh_b = ball(0.8, 0);
  const MeshQuery a(mesh_a);
  const MeshQuery b(mesh_b);
  const auto edge_meets = [](const TriangleMesh& mesh, const MeshQuery& other) {
    for (const Face& f : mesh.faces) {
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d& p = mesh.vertices[f[i]];
        const Eigen::Vector3d d = mesh.vertices[f[(i + 1) % 3]] - p;
        const auto hit = other.first_hit(p, d);
        if (hit && hit->distance <= d.norm()) return true;
      }
    }
    return false;
  };
  Random random(42);
  int hits = 0;
  for (int i = 0; i < 200; ++i) {
    const RigidTransform X = drawn_pose(random, 2.0);
    const TriangleMesh moved = transformed(mesh_b, X);
    const bool expected = edge_meets(moved, a) || edge_meets(mesh_a, MeshQuery(moved)) ||
                          a.containment(moved.vertices[0]) == Containment::Inside;
    CHECK(do_intersect(a, b, X) == expected);
    hits += expected;
  }
  CHECK(hits > 30);
  CHECK(hits < 170);
}

TEST_CASE("Two balls penetrate by the sum of their radii less their distance",
          "[geometry][mesh_intersection]") {
  const double flatness = 0.0013;  // Middles of the faces of ball(·, 4) lie 0.13 % inside.
  const MeshQuery a(ball(0.10, 4));
  const MeshQuery b(ball(0.03, 4));
  for (const double apart : {0.129, 0.125, 0.12, 0.11, 0.08}) {
    const Penetration p = penetration(a, b, shift(0.6 * apart, 0.8 * apart, 0.0));
    CHECK(p.intersects);
    CHECK(p.depth <= p.depth_bound);
    CHECK(p.depth_bound - p.depth <= 1.1e-5);
    // The deepest point of b is its pole towards a's center, that of a likewise; both are
    // ra + rb − apart deep as long as they are not past the other's center.
    CHECK(p.depth == Approx(0.13 - apart).margin(1.1e-5 + 0.13 * flatness));
  }
}

TEST_CASE("A ball deep inside a ball penetrates by its farthest point",
          "[geometry][mesh_intersection]") {
  // Small ball at distance 0.02 from the center of radius 0.1: its surface is deepest at the point
  // nearest to the center, 0.02 − 0.03 < 0 past it: the center itself is not on the surface, the
  // least distance of the surface from the center is 0.01.
  const Penetration p =
      penetration(MeshQuery(ball(0.10, 4)), MeshQuery(ball(0.03, 4)), shift(0, 0, 0.02));
  CHECK(p.depth == Approx(0.09).margin(3e-4));
}

TEST_CASE("Boxes pressed face on face penetrate by their overlap",
          "[geometry][mesh_intersection]") {
  // The small face lies 0.002 inside the large box; it is the hard case, deep all over.
  const MeshQuery table(box({0.2, 0.2, 0.1}));
  const MeshQuery block(box({0.05, 0.05, 0.05}));
  const Penetration p = penetration(table, block, shift(0.01, 0.02, 0.05 + 0.025 - 0.002));
  CHECK(p.depth == Approx(0.002).margin(1e-5));
  CHECK(p.depth_bound >= 0.002 - 1e-12);
  CHECK(p.depth_bound <= 0.002 + 1.1e-5);
  CHECK(p.deepest_point_A[2] == Approx(0.048).margin(1e-5));
}

TEST_CASE("Penetration does not depend on how finely a mesh is cut",
          "[geometry][mesh_intersection]") {
  // A corner of a box of twelve faces in a ball, where only vertices of the ball are near.
  const MeshQuery coarse(box({0.1, 0.1, 0.1}));
  const MeshQuery sphere(ball(0.05, 3));
  const RigidTransform X = shift(0.05, 0.05, 0.05);
  const Penetration p = penetration(coarse, sphere, X);
  const Penetration q = penetration(sphere, coarse, X.inverse());
  CHECK(p.depth == Approx(q.depth).margin(1.1e-5));
  // The box's corner is the ball's center: its depth is the ball's inner radius, and no other point
  // of either surface is deeper.
  CHECK(p.depth == Approx(0.05).margin(4e-4));
}

TEST_CASE("Touching solids intersect with no depth", "[geometry][mesh_intersection]") {
  const MeshQuery cube(box({2, 2, 2}));
  const Penetration p = penetration(cube, cube, shift(2, 0.5, 0));
  CHECK(p.intersects);
  CHECK(p.depth == 0.0);
  // Faces that coincide are the hardest case; work may end before the tolerance is met.
  CHECK(p.depth_bound <= 2e-3);
}

TEST_CASE("The distance of two boxes is that of their nearest features",
          "[geometry][mesh_intersection]") {
  const MeshQuery cube(box({2, 2, 2}));
  CHECK(distance(cube, cube, shift(5, 0, 0)).distance == Approx(3.0));
  CHECK(distance(cube, cube, shift(5, 6, 0)).distance == Approx(5.0));  // Edges: 3, 4.
  CHECK(distance(cube, cube, shift(4, 4, 3)).distance == Approx(3.0));  // Corners: 2, 2, 1.
  const MeshDistance d = distance(cube, cube, shift(4, 4, 3));
  CHECK((d.point_on_a_A - Eigen::Vector3d(1, 1, 1)).norm() < 1e-12);
  CHECK((d.point_on_b_A - Eigen::Vector3d(3, 3, 2)).norm() < 1e-12);
}

TEST_CASE("Witness points lie on both surfaces at their distance",
          "[geometry][mesh_intersection]") {
  const MeshQuery a(torus(0.1, 0.03, 32, 16));
  const MeshQuery b(capsule(0.01, 0.05, 16));
  Random random(43);
  for (int i = 0; i < 50; ++i) {
    const RigidTransform X = drawn_pose(random, 0.2);
    const MeshDistance d = distance(a, b, X);
    if (d.distance == 0.0) continue;
    CHECK((d.point_on_a_A - d.point_on_b_A).norm() == Approx(d.distance));
    CHECK(std::sqrt(a.closest_point(d.point_on_a_A).squared_distance) < 1e-12);
    CHECK(std::sqrt(b.closest_point(X.inverse() * d.point_on_b_A).squared_distance) < 1e-12);
    // No vertex of b is nearer.
    for (const auto& vertex : b.mesh().vertices) {
      CHECK(std::sqrt(a.closest_point(X * vertex).squared_distance) >= d.distance * (1 - 1e-12));
    }
  }
}

TEST_CASE("A tolerance that is not positive is refused", "[geometry][mesh_intersection]") {
  const MeshQuery cube(box({2, 2, 2}));
  for (const double bad : {0.0, -1.0, std::nan("")}) {
    CHECK_THROWS_AS(penetration(cube, cube, shift(0, 0, 0), {.tolerance = bad}), InvalidInput);
  }
}
