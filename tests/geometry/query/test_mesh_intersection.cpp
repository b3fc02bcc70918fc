#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/rational_clip.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

namespace test_mesh_intersection {

using namespace graspfit::base;
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
  // They touch face on face, edge on edge, corner on corner; then they are apart by one ulp of 2.
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
    // The polyhedra are up to 1 % inside their balls.
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
  // Convex bodies intersect if and only if a vertex of one is inside the other or an edge of one
  // meets a face of the other; rays of the query decide the latter.
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

TEST_CASE("Down to the last bit of a touch, a placed mesh intersects as the mesh moved there",
          "[geometry][mesh_intersection]") {
  // The reference is the moved body itself, which needs no turned boxes and no inverse. Some poses
  // have a rotation that is one to the digits of a file only, or are far from the origin.
  const std::vector<std::pair<TriangleMesh, TriangleMesh>> solids = {
      {ball(1.0, 2), box({0.7, 1.1, 0.4})},
      {torus(1.0, 0.3, 24, 12), torus(0.8, 0.2, 16, 8)},
      {box({2, 2, 2}), box({1, 2, 3})}};
  Random random(43);
  int touches = 0;
  for (int i = 0; i < 90; ++i) {
    const TriangleMesh& mesh_a = solids[i % solids.size()].first;
    const TriangleMesh& mesh_b = solids[i % solids.size()].second;
    RigidTransform X = drawn_pose(random, 1.0);
    if (i % 2 == 1) X.linear() = (X.linear() * 1e6).array().round() / 1e6;
    const double far = i % 5 == 0 ? 1000.0 : 0.0;
    const MeshQuery a(transformed(mesh_a, shift(far, 0, 0)));
    const MeshQuery b(mesh_b);
    const Eigen::Vector3d direction = drawn_pose(random, 1.0).linear().col(0);
    double inside = 0.0, outside = 10.0;
    const auto intersects = [&](double way) {
      X.translation() = way * direction + Eigen::Vector3d(far, 0, 0);
      const bool found = do_intersect(a, b, X);
      CHECK(found ==
            do_intersect(a, MeshQuery(transformed(mesh_b, X)), RigidTransform::Identity()));
      return found;
    };
    // Through the middle of a ring, the start is free, too; then there is no touch to look for.
    if (!intersects(inside)) continue;
    REQUIRE_FALSE(intersects(outside));
    for (double middle = 5.0; inside < middle && middle < outside;
         middle = 0.5 * (inside + outside)) {
      (intersects(middle) ? inside : outside) = middle;
    }
    ++touches;
  }
  CHECK(touches >= 60);  // These are all balls and boxes.
}

namespace {

TriangleMesh tetrahedron(const std::array<Eigen::Vector3d, 4>& corners) {
  TriangleMesh mesh;
  mesh.vertices.assign(corners.begin(), corners.end());
  mesh.faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return mesh;
}

// Whether a face of a large body, turned in place so that its rounded corners leave the origin
// aside, is met by a tiny body that lies across it where it is nearest to the origin. Empty if the
// face is too near the origin, or not across after all.
std::optional<bool> meets_across_rounded_face(const Eigen::Matrix3d& turn) {
  using namespace graspfit::testing;
  const TriangleMesh large =
      tetrahedron({Eigen::Vector3d(1000, 0, 0), {-500, 800, 0}, {-500, -800, 0}, {0, 0, -1000}});
  RigidTransform X = RigidTransform::Identity();
  X.linear() = turn;
  const TriangleMesh placed = transformed(large, X);
  const RationalPoint a = exactly(placed.vertices[0]);
  const RationalPoint normal =
      cross(minus(exactly(placed.vertices[1]), a), minus(exactly(placed.vertices[2]), a));
  const Rational share = dot(normal, a) / dot(normal, normal);
  Eigen::Vector3d foot;
  for (int axis = 0; axis < 3; ++axis) foot[axis] = CGAL::to_double(Rational(share * normal[axis]));
  const double size = 0.1 * foot.norm();
  if (!(size > 1e-17)) return std::nullopt;
  const TriangleMesh tiny = tetrahedron(
      {foot + size * Eigen::Vector3d(1, 1, 1), foot + size * Eigen::Vector3d(1, -1, -1),
       foot + size * Eigen::Vector3d(-1, 1, -1), foot + size * Eigen::Vector3d(-1, -1, 1)});
  bool is_above = false;
  bool is_below = false;
  for (const Eigen::Vector3d& corner : tiny.vertices) {
    const Rational height = dot(minus(exactly(corner), a), normal);
    is_above = is_above || height > 0;
    is_below = is_below || height < 0;
  }
  if (!is_above || !is_below) return std::nullopt;
  return do_intersect(MeshQuery(tiny), MeshQuery(large), X);
}

}  // namespace

TEST_CASE("Rounding of a large body's corners hides no tiny body that they pass",
          "[geometry][mesh_intersection]") {
  // The rounded face is beyond the origin by 2.7e-14 here, four times the size of the tiny body, in
  // whose coordinates there is nothing to tell how far the corners of the large one are rounded.
  Eigen::Matrix3d turn;
  turn << -.8932626918727107, -.44946735189607523, .007801467031819165, .3125695942795991,
      -.6085349107996088, .7293733687693836, -.3230820515599802, .6539605201521282,
      .6840713603434603;
  const std::optional<bool> known = meets_across_rounded_face(turn);
  REQUIRE(known);
  CHECK(*known);
  Random random(48);
  int num_met = 0;
  for (int i = 0; i < 200; ++i) {
    const std::optional<bool> meets = meets_across_rounded_face(drawn_pose(random, 0.0).linear());
    if (!meets) continue;
    INFO("turn " << i);
    CHECK(*meets);
    ++num_met;
  }
  CHECK(num_met > 100);
}

TEST_CASE("Whether triangles intersect does not depend on their scale, down to 1e-108 m",
          "[geometry][mesh_intersection]") {
  // Vertices on a lattice, where every third pair touches or crosses. Powers of two change no bit
  // of a coordinate, but products of three coordinates at 2^-358 are subnormal.
  Random random(358);
  int num_met = 0;
  for (int round = 0; round < 3000; ++round) {
    std::array<TriangleMesh, 2> pair;
    for (TriangleMesh& mesh : pair) {
      for (int i = 0; i < 3; ++i) {
        Eigen::Vector3d& vertex = mesh.vertices.emplace_back();
        for (double& x : vertex) x = static_cast<double>(random.index(17)) / 8.0 - 1.0;
      }
      mesh.faces = {{0, 1, 2}};
    }
    std::array<TriangleMesh, 2> tiny = pair;
    for (TriangleMesh& mesh : tiny) {
      for (Eigen::Vector3d& vertex : mesh.vertices) vertex *= 0x1p-358;
    }
    const auto meet = [](const std::array<TriangleMesh, 2>& of) {
      return do_intersect(MeshQuery(of[0]), MeshQuery(of[1]), RigidTransform::Identity());
    };
    const bool do_meet = meet(pair);
    num_met += do_meet ? 1 : 0;
    INFO("round " << round);
    REQUIRE(meet(tiny) == do_meet);
  }
  CHECK(num_met > 300);
}

TEST_CASE("Two balls penetrate by the sum of their radii less their distance",
          "[geometry][mesh_intersection]") {
  // The middles of the faces of ball(·, 4) are 0.13 % inside.
  const double flatness = 0.0013;
  const MeshQuery a(ball(0.10, 4));
  const MeshQuery b(ball(0.03, 4));
  for (const double apart : {0.129, 0.125, 0.12, 0.11, 0.08}) {
    const Penetration p = penetration(a, b, shift(0.6 * apart, 0.8 * apart, 0.0));
    CHECK(p.intersects);
    CHECK(p.depth <= p.depth_bound);
    CHECK(p.depth_bound - p.depth <= 1.1e-5);
    // The deepest point of b is its pole towards a's center, and that of a likewise; both are ra +
    // rb − apart deep as long as they are not past the other's center.
    CHECK(p.depth == Approx(0.13 - apart).margin(1.1e-5 + 0.13 * flatness));
    // If the search is stopped early, it has found enough if there is as much, and its bound holds.
    for (const double enough : {0.0, 0.5 * p.depth, 2.0 * p.depth}) {
      const Penetration early =
          penetration(a, b, shift(0.6 * apart, 0.8 * apart, 0.0), {.enough = enough});
      CHECK((early.depth > enough) == (p.depth > enough));
      CHECK(early.depth_bound >= p.depth);
    }
  }
}

TEST_CASE("A ball deep inside a ball penetrates by its farthest point",
          "[geometry][mesh_intersection]") {
  // A small ball is at distance 0.02 from the center of a ball of radius 0.1. Its surface is
  // deepest at the point nearest to the center, 0.02 − 0.03 < 0 past it: the center itself is not
  // on the surface, and the least distance of the surface from the center is 0.01.
  const Penetration p =
      penetration(MeshQuery(ball(0.10, 4)), MeshQuery(ball(0.03, 4)), shift(0, 0, 0.02));
  CHECK(p.depth == Approx(0.09).margin(3e-4));
}

TEST_CASE("Boxes pressed face on face penetrate by their overlap",
          "[geometry][mesh_intersection]") {
  // The small face is 0.002 inside the large box, which is the hard case, as it is deep all over.
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
  // A corner of a box of twelve faces is in a ball, where only vertices of the ball are near.
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
  CHECK(p.depth_bound <= 1e-5);
}

TEST_CASE("Above a floor the bounds of a depth are those of the whole search",
          "[geometry][mesh_intersection]") {
  const MeshQuery a(torus(0.1, 0.03, 32, 16));
  const MeshQuery b(capsule(0.01, 0.05, 16));
  Random random(47);
  int num_deeper = 0, num_overlapping = 0;
  for (int i = 0; i < 200; ++i) {
    const RigidTransform X = drawn_pose(random, 0.1);
    const Penetration p = penetration(a, b, X);
    num_overlapping += p.intersects;
    for (const double floor : {0.0, 0.002, 0.01}) {
      const DepthBounds bounds = depth_above(a, b, X, floor);
      CHECK(bounds.at_least <= p.depth_bound);
      CHECK(bounds.at_most >= p.depth);
      CHECK((bounds.at_least == 0.0 || bounds.at_least > floor));
      CHECK(bounds.at_most <= std::max(floor, bounds.at_least) + 1.1e-5);
      num_deeper += bounds.at_least > 0.0;
    }
  }
  CHECK(num_overlapping > 40);
  CHECK(num_deeper > 40);
  CHECK(num_deeper < 3 * num_overlapping);
  // It is inside, without a crossing of the surfaces, and its farthest point is 0.09 deep.
  const MeshQuery large(ball(0.10, 4)), small(ball(0.03, 4));
  CHECK(depth_above(large, small, shift(0, 0, 0.02), 0.05).at_least == Approx(0.09).margin(3e-4));
  CHECK(depth_above(small, large, shift(0, 0, 0.02), 0.05).at_least == Approx(0.09).margin(3e-4));
  CHECK(depth_above(large, small, shift(0, 0, 0.02), 0.095).at_least == 0.0);
  CHECK(depth_above(large, small, shift(0, 0, 0.2), 0.0).at_most == 0.0);
}

TEST_CASE("The distance of two boxes is that of their nearest features",
          "[geometry][mesh_intersection]") {
  const MeshQuery cube(box({2, 2, 2}));
  CHECK(distance(cube, cube, shift(5, 0, 0)).distance == Approx(3.0));
  // Edges are apart by 3 and 4.
  CHECK(distance(cube, cube, shift(5, 6, 0)).distance == Approx(5.0));
  // Corners are apart by 2, 2 and 1.
  CHECK(distance(cube, cube, shift(4, 4, 3)).distance == Approx(3.0));
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

TEST_CASE("A tolerance that is not positive, or less than nothing as enough, is refused",
          "[geometry][mesh_intersection]") {
  const MeshQuery cube(box({2, 2, 2}));
  for (const double bad : {0.0, -1.0, std::nan("")}) {
    CHECK_THROWS_AS(penetration(cube, cube, shift(0, 0, 0), {.tolerance = bad}), InvalidInput);
  }
  for (const double bad : {-1.0, std::nan("")}) {
    CHECK_THROWS_AS(penetration(cube, cube, shift(0, 0, 0), {.enough = bad}), InvalidInput);
  }
  CHECK_THROWS_AS(depth_above(cube, cube, shift(0, 0, 0), -1.0), InvalidInput);
}

namespace {

// The depth of `inner`'s surface in `outer` over a grid of `steps` per edge on each face: never
// more than the true depth, and less by at most the grid's spacing.
struct SampledDepth {
  double depth = 0.0;
  double spacing = 0.0;
};
SampledDepth sampled_depth(const MeshQuery& outer, const TriangleMesh& inner, int steps) {
  SampledDepth result;
  for (std::size_t face = 0; face < inner.faces.size(); ++face) {
    const auto [a, b, c] = corners(inner, face);
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; i + j <= steps; ++j) {
        const double s = outer.signed_distance(a + (b - a) * i / steps + (c - a) * j / steps);
        result.depth = std::max(result.depth, -s);
      }
    }
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    result.spacing = std::max(result.spacing, longest / steps);
  }
  return result;
}

}  // namespace

TEST_CASE("Penetration brackets what a dense grid on both surfaces finds",
          "[geometry][mesh_intersection]") {
  const std::vector<TriangleMesh> bodies = {box({0.1, 0.06, 0.03}), ball(0.04, 1),
                                            torus(0.05, 0.02, 8, 6)};
  Random random(44);
  int overlaps = 0;
  for (int i = 0; i < 24; ++i) {
    const MeshQuery a(bodies[random.index(3)]);
    const MeshQuery b(bodies[random.index(3)]);
    const RigidTransform X = drawn_pose(random, 0.05);
    const Penetration p = penetration(a, b, X);
    if (!p.intersects) continue;
    ++overlaps;
    const SampledDepth in_a = sampled_depth(a, transformed(b.mesh(), X), 24);
    const SampledDepth in_b = sampled_depth(b, transformed(a.mesh(), X.inverse()), 24);
    const double depth = std::max(in_a.depth, in_b.depth);
    CHECK(p.depth_bound >= depth - 1e-12);
    CHECK(p.depth <= depth + std::max(in_a.spacing, in_b.spacing));
    CHECK(p.depth_bound - p.depth <= 1.01e-5);
    // The depth is attained where it says.
    const double at_a = a.signed_distance(p.deepest_point_A);
    const double at_b = b.signed_distance(X.inverse() * p.deepest_point_A);
    CHECK((std::abs(at_a + p.depth) < 1e-12 || std::abs(at_b + p.depth) < 1e-12));
  }
  CHECK(overlaps > 10);
}

TEST_CASE("Penetration of coinciding faces is tight however they are cut",
          "[geometry][mesh_intersection]") {
  // The bodies are flush stacks, the second turned or finer, touching or overlapping by `deep`;
  // small bodies on a large table; and the same body in its own place.
  const MeshQuery table(box({0.6, 0.4, 0.05}));
  for (const double deep : {0.0, 1e-3}) {
    for (const double angle : {0.0, 0.3}) {
      for (const TriangleMesh& mesh : {box({0.05, 0.07, 0.02}), cylinder(0.03, 0.02, 48)}) {
        RigidTransform X = shift(0.013, -0.021, 0.025 + 0.01 - deep);
        X.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
        const Penetration p = penetration(table, MeshQuery(mesh), X);
        CHECK(p.intersects);
        CHECK(p.depth == Approx(deep).margin(1e-5));
        CHECK(p.depth_bound >= deep - 1e-12);
        CHECK(p.depth_bound <= deep + 1.01e-5);
      }
    }
  }
  const MeshQuery can(cylinder(0.03, 0.1, 32));
  const Penetration self = penetration(can, can, RigidTransform::Identity());
  CHECK(self.intersects);
  CHECK(self.depth_bound <= 1.01e-5);
}

TEST_CASE("The distance of convex bodies is where projecting to and fro comes to rest",
          "[geometry][mesh_intersection]") {
  // Alternating projections onto two convex sets converge to a nearest pair [Cheney & Goldstein
  // 1959]; from outside the closest point of the surface is the projection onto the body.
  const MeshQuery a(box({1, 2, 0.5}));
  const TriangleMesh mesh_b = ball(0.5, 0);
  const MeshQuery b(mesh_b);
  Random random(45);
  int apart = 0;
  for (int i = 0; i < 40; ++i) {
    const RigidTransform X = drawn_pose(random, 2.0);
    const MeshDistance d = distance(a, b, X);
    if (d.distance == 0.0) continue;
    ++apart;
    const MeshQuery placed(transformed(mesh_b, X));
    Eigen::Vector3d on_a = a.closest_point(X.translation()).point;
    double gap = 0.0;
    for (int step = 0; step < 3000; ++step) {
      const Eigen::Vector3d on_b = placed.closest_point(on_a).point;
      on_a = a.closest_point(on_b).point;
      gap = (on_a - on_b).norm();
    }
    CHECK(d.distance <= gap * (1.0 + 1e-12));
    CHECK(d.distance >= gap * (1.0 - 1e-6));  // Nearly parallel faces converge slowly.
  }
  CHECK(apart > 15);
}

}  // namespace test_mesh_intersection
