#include <cmath>
#include <limits>
#include <numbers>

#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

using namespace graspfit::geometry;

namespace {

Eigen::Vector3d drawn(Random& random, double size) {
  const double x = random.uniform(-size, size);
  const double y = random.uniform(-size, size);
  const double z = random.uniform(-size, size);
  return {x, y, z};
}

TriangleMesh turned_inward(TriangleMesh mesh) {
  for (Face& f : mesh.faces) std::swap(f[1], f[2]);
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, const Eigen::Vector3d& by) {
  for (auto& vertex : mesh.vertices) vertex += by;
  return mesh;
}

// Least distance to a triangle by ternary search in its two coordinates: slow, but another way.
double distance_to_triangle(const Eigen::Vector3d& point, const std::array<Eigen::Vector3d, 3>& t) {
  const auto along = [&](double u) {
    const Eigen::Vector3d p = t[0] + u * (t[1] - t[0]);
    const Eigen::Vector3d q = t[0] + u * (t[2] - t[0]);
    const Eigen::Vector3d d = q - p;
    const double squared = d.squaredNorm();
    const double v = squared > 0 ? std::clamp((point - p).dot(d) / squared, 0.0, 1.0) : 0.0;
    return (p + v * d - point).norm();
  };
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 200; ++i) {
    const double a = low + (high - low) / 3;
    const double b = high - (high - low) / 3;
    (along(a) < along(b) ? high : low) = along(a) < along(b) ? b : a;
  }
  return along(0.5 * (low + high));
}

}  // namespace

TEST_CASE("The closest point is that of brute force", "[geometry][mesh_query]") {
  const TriangleMesh mesh = torus(1.0, 0.4, 14, 9);
  const MeshQuery query(mesh);
  Random random(31);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d point = drawn(random, 2.0);
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
      best = std::min(best, distance_to_triangle(point, corners(mesh, face)));
    }
    const ClosestPoint found = query.closest_point(point);
    CHECK(std::sqrt(found.squared_distance) == Approx(best).epsilon(1e-9));
    CHECK((found.point - point).squaredNorm() == found.squared_distance);
    CHECK(distance_to_triangle(found.point, corners(mesh, found.face)) < 1e-9);
  }
}

TEST_CASE("Of equally near faces the closest point names the first", "[geometry][mesh_query]") {
  const MeshQuery cube(box({2, 2, 2}));
  // At a vertex of the mesh all faces around it are equally near.
  const Eigen::Vector3d corner(1, 1, 1);
  const ClosestPoint found = cube.closest_point(corner + Eigen::Vector3d(1, 1, 1));
  CHECK(found.point == corner);
  std::int32_t first = -1;
  for (std::size_t face = 12; face-- > 0;) {
    for (const auto& p : corners(cube.mesh(), face)) {
      if (p == corner) first = static_cast<std::int32_t>(face);
    }
  }
  CHECK(found.face == first);
}

TEST_CASE("Containment in a ball and a torus agrees with their equations",
          "[geometry][mesh_query]") {
  const MeshQuery sphere(ball(1.0, 4));
  const MeshQuery ring(torus(1.0, 0.4, 96, 48));
  Random random(32);
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d p = drawn(random, 1.5);
    // The polyhedra lie inside the smooth bodies by at most 0.5 %.
    const double r = p.norm();
    if (r < 0.995 || r > 1.0) {
      CHECK((sphere.containment(p) == Containment::Inside) == (r < 1.0));
    }
    const double tube = std::hypot(std::hypot(p[0], p[1]) - 1.0, p[2]) / 0.4;
    if (tube < 0.99 || tube > 1.0) {
      CHECK((ring.containment(p) == Containment::Inside) == (tube < 1.0));
    }
  }
}

TEST_CASE("Vertices, edges and faces are on the surface, an ulp beside is not",
          "[geometry][mesh_query]") {
  const MeshQuery cube(box({2, 2, 2}));
  // All points of the lattice {−2, −1, …, 2}/1: rays along x run through edges, vertices and faces.
  for (int x = -4; x <= 4; ++x) {
    for (int y = -4; y <= 4; ++y) {
      for (int z = -4; z <= 4; ++z) {
        const Eigen::Vector3d p = 0.5 * Eigen::Vector3d(x, y, z);
        const double far = p.cwiseAbs().maxCoeff();
        const Containment expected = far < 1.0    ? Containment::Inside
                                     : far == 1.0 ? Containment::OnSurface
                                                  : Containment::Outside;
        CHECK(cube.containment(p) == expected);
      }
    }
  }
  const double below = std::nextafter(1.0, 0.0);
  const double above = std::nextafter(1.0, 2.0);
  for (const double t : {0.0, 0.5, -1.0}) {
    CHECK(cube.containment({below, below * t, below * t}) == Containment::Inside);
    CHECK(cube.containment({above, t, t}) == Containment::Outside);
  }
  for (const auto& vertex : ball(0.3, 3).vertices) {
    CHECK(MeshQuery(ball(0.3, 3)).containment(vertex) == Containment::OnSurface);
    if (vertex[2] > 0.2) break;  // A few will do.
  }
}

TEST_CASE("Containment is the same whichever way the solid is turned", "[geometry][mesh_query]") {
  // Rays along x meet vertices and edges exactly in each of the 24 turns of the octahedron.
  TriangleMesh mesh = ball(1.0, 0);
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  const MeshQuery query(mesh);
  for (int x = -5; x <= 5; ++x) {
    for (int y = -5; y <= 5; ++y) {
      for (int z = -5; z <= 5; ++z) {
        const int sum = std::abs(x) + std::abs(y) + std::abs(z);
        const Containment expected = sum < 4    ? Containment::Inside
                                     : sum == 4 ? Containment::OnSurface
                                                : Containment::Outside;
        CHECK(query.containment(0.25 * Eigen::Vector3d(x, y, z)) == expected);
      }
    }
  }
}

TEST_CASE("Overlapping parts are united and an inward part is a cavity", "[geometry][mesh_query]") {
  const TriangleMesh cube = box({2, 2, 2});
  const MeshQuery overlapping(concatenated({cube, moved(cube, {1, 0, 0})}));
  CHECK(overlapping.containment({-0.5, 0, 0}) == Containment::Inside);
  CHECK(overlapping.containment({0.5, 0, 0}) == Containment::Inside);
  CHECK(overlapping.containment({1.5, 0, 0}) == Containment::Inside);
  CHECK(overlapping.containment({2.5, 0, 0}) == Containment::Outside);

  const MeshQuery hollow(concatenated({cube, turned_inward(box({1, 1, 1}))}));
  CHECK(hollow.containment({0, 0, 0}) == Containment::Outside);
  CHECK(hollow.containment({0.75, 0, 0}) == Containment::Inside);
  CHECK(hollow.signed_distance({0, 0, 0}) == Approx(0.5));
  CHECK(hollow.signed_distance({0.75, 0, 0}) == Approx(-0.25));

  const MeshQuery nested(concatenated({cube, box({1, 1, 1})}));
  CHECK(nested.containment({0, 0, 0}) == Containment::Inside);
}

TEST_CASE("The signed distance of a box is that of its formula", "[geometry][mesh_query]") {
  const MeshQuery query(box({2, 4, 6}));
  Random random(33);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d p = drawn(random, 5.0);
    const Eigen::Vector3d q = p.cwiseAbs() - Eigen::Vector3d(1, 2, 3);
    const double expected = q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
    CHECK(query.signed_distance(p) == Approx(expected).epsilon(1e-12).margin(1e-15));
  }
  CHECK(query.signed_distance({1, 0, 0}) == 0.0);
}

TEST_CASE("A ray hits a box where it should", "[geometry][mesh_query]") {
  const MeshQuery query(box({2, 2, 2}));
  const auto hit = query.first_hit({-5, 0.25, 0.5}, {2, 0, 0});
  REQUIRE(hit);
  CHECK(hit->distance == Approx(4.0));
  CHECK((hit->point - Eigen::Vector3d(-1, 0.25, 0.5)).norm() < 1e-14);
  CHECK(face_normal(query.mesh(), hit->face) == Eigen::Vector3d(-1, 0, 0));
  const auto from_inside = query.first_hit({0, 0.25, 0.5}, {0, -1, 0});
  REQUIRE(from_inside);
  CHECK(from_inside->distance == Approx(1.25));
  CHECK_FALSE(query.first_hit({-5, 0, 0}, {-1, 0, 0}));
  CHECK_FALSE(query.first_hit({-5, 1.5, 0}, {1, 0, 0}));
  CHECK(query.first_hit({1, 0.25, 0.5}, {1, 0, 0})->distance == 0.0);  // Starts on the face.
}

TEST_CASE("No ray leaves a closed surface unnoticed", "[geometry][mesh_query]") {
  const TriangleMesh mesh = ball(1.0, 3);
  const MeshQuery query(mesh);
  Random random(34);
  const Eigen::Vector3d origin = drawn(random, 0.3);
  // Straight at vertices and at the middles of edges, where two or six faces meet.
  for (const Face& f : mesh.faces) {
    const Eigen::Vector3d& a = mesh.vertices[f[0]];
    const Eigen::Vector3d& b = mesh.vertices[f[1]];
    for (const Eigen::Vector3d& target : {a, Eigen::Vector3d(0.5 * (a + b))}) {
      const auto hit = query.first_hit(origin, target - origin);
      REQUIRE(hit);
      CHECK(hit->distance == Approx((target - origin).norm()).epsilon(1e-12));
    }
  }
}

TEST_CASE("Faces near a box are those whose own box meets it", "[geometry][mesh_query]") {
  const TriangleMesh mesh = torus(1.0, 0.4, 20, 10);
  const MeshQuery query(mesh);
  Random random(35);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d a = drawn(random, 1.5);
    Eigen::AlignedBox3d near(a);
    near.extend(drawn(random, 1.5));
    std::vector<std::int32_t> expected;
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
      Eigen::AlignedBox3d own;
      for (const auto& corner : corners(mesh, face)) own.extend(corner);
      if (own.intersects(near)) expected.push_back(static_cast<std::int32_t>(face));
    }
    CHECK(query.faces_near(near) == expected);
  }
}

TEST_CASE("One face, equal faces and degenerate faces can be asked", "[geometry][mesh_query]") {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
  mesh.faces.assign(100, {0, 1, 2});
  CHECK(MeshQuery(mesh).closest_point({0.25, 0.25, 3}).face == 0);
  CHECK(MeshQuery(mesh).closest_point({0.25, 0.25, 3}).squared_distance == Approx(9.0));
  mesh.faces = {{0, 1, 3}};  // Collinear: the segment from 0 to 2.
  const MeshQuery segment(mesh);
  CHECK((segment.closest_point({1.5, 1, 0}).point - Eigen::Vector3d(1.5, 0, 0)).norm() < 1e-15);
  CHECK(segment.containment({1.5, 0, 0}) == Containment::OnSurface);
  CHECK(segment.containment({1.5, 1, 0}) == Containment::Outside);
  mesh.faces = {{0, 0, 0}};
  CHECK(MeshQuery(mesh).closest_point({3, 4, 0}).squared_distance == Approx(25.0));
}

TEST_CASE("A mesh without faces and a ray without direction are refused",
          "[geometry][mesh_query]") {
  CHECK_THROWS_WITH(MeshQuery(TriangleMesh{}), "MeshQuery: the mesh has no faces");
  const MeshQuery query(box({1, 1, 1}));
  CHECK_THROWS_AS(query.first_hit({0, 0, 0}, {0, 0, 0}), InvalidInput);
  CHECK_THROWS_AS(query.first_hit({0, 0, 0}, {std::nan(""), 0, 0}), InvalidInput);
}

TEST_CASE("Copies of a query share the tree", "[geometry][mesh_query]") {
  const MeshQuery query(box({1, 1, 1}));
  const MeshQuery copy = query;
  CHECK(&copy.mesh() == &query.mesh());
}
