#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "geometry/changed_meshes.hpp"
#include "geometry/rational_distance.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

namespace test_mesh_query {

using namespace graspfit::base;
using namespace graspfit::geometry;
using graspfit::testing::moved;

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

// Finds the least distance to a triangle by ternary search in its two coordinates, which is slow,
// but another way.
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

namespace {

// A mesh of one face.
TriangleMesh one_face(const std::array<Eigen::Vector3d, 3>& corners) {
  TriangleMesh mesh;
  mesh.vertices.assign(corners.begin(), corners.end());
  mesh.faces = {{0, 1, 2}};
  return mesh;
}

// How far a distance found is from that in rationals.
double error_of_distance(const std::array<Eigen::Vector3d, 3>& corners,
                         const Eigen::Vector3d& point) {
  using namespace graspfit::testing;
  const ClosestPoint found = MeshQuery(one_face(corners)).closest_point(point);
  CHECK((found.barycentric.minCoeff() >= 0.0 && std::abs(found.barycentric.sum() - 1.0) < 1e-15));
  const double exact = rounded_root(squared_distance_to_triangle(exactly(point), exactly(corners)));
  return std::abs(std::sqrt(found.squared_distance) - exact);
}

}  // namespace

TEST_CASE("A point beside a needle is as near to it as rationals say", "[geometry][mesh_query]") {
  // Weights by differences of products of four lengths are off by 8.6 mm here.
  const std::array<Eigen::Vector3d, 3> needle = {
      Eigen::Vector3d(.006875325561880918, .04856351355379239, -.04510422083100651),
      {.05509929264263349, .1219441459962315, .002746921071169077},
      {.026541782603122302, .0784892364092193, -.02558980620285316}};
  const Eigen::Vector3d point(.04122389500899004, .10036811426080357, -.011170286302036724);
  CHECK(error_of_distance(needle, point) < 1e-16);
}

TEST_CASE("However thin a triangle is, the distance from it is that in rationals",
          "[geometry][mesh_query]") {
  // The bound of `closest_point`, which the fattest slivers come nearest to: 2.3e-13 of the longest
  // edge and an ulp or two of coordinates and distances below 0.5.
  constexpr double kLongest = 0.1;
  constexpr double kBound = 2.3e-13 * kLongest + 2e-16;
  Random random(39);
  for (double thinness = 0.1; thinness > 1e-17; thinness *= 0.1) {
    for (const double aside : {0.0, 1e-6, 1e-3, 0.3}) {
      for (int i = 0; i < 60; ++i) {
        CAPTURE(thinness, aside, i);
        const Eigen::Vector3d along = drawn(random, 1.0).normalized();
        const Eigen::Vector3d across = along.cross(drawn(random, 1.0)).normalized();
        const Eigen::Vector3d start = drawn(random, 0.1);
        // The third corner is over the middle of the long edge, or near one of its ends.
        const std::array<double, 3> places = {random.uniform(), thinness * random.uniform(),
                                              1.0 - thinness * random.uniform()};
        std::array<Eigen::Vector3d, 3> corners = {
            start, start + kLongest * along,
            start + kLongest * (places[i % 3] * along + thinness * across)};
        std::rotate(corners.begin(), corners.begin() + random.index(3), corners.end());
        if (random.index(2) == 0) std::swap(corners[0], corners[1]);
        double s = random.uniform();
        double t = random.uniform();
        if (s + t > 1.0) {
          s = 1.0 - s;
          t = 1.0 - t;
        }
        // Every fourth point is not over the triangle but beside it.
        const double beyond = i % 4 == 0 ? 1.5 : 1.0;
        const Eigen::Vector3d point = corners[0] + beyond * s * (corners[1] - corners[0]) +
                                      beyond * t * (corners[2] - corners[0]) +
                                      aside * random.uniform(-1.0, 1.0) * along.cross(across);
        CHECK(error_of_distance(corners, point) <= kBound);
      }
    }
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

TEST_CASE("Of equally near faces the first is named where the nearest point is a rounded corner",
          "[geometry][mesh_query]") {
  // On the first edge the point beside its end is rounded to 2.8e-16 from the query, while the box
  // of the face is 3.1e-16 from it.
  const TriangleMesh face =
      one_face({Eigen::Vector3d(-1.201657872665272, -1.7004130315403063, -1.974613905170196),
                {.00819522451100609, .0050873999458690335, .008686092947757452},
                {-1.0, 0.0, 0.0}});
  const Eigen::Vector3d point(.008195224511006398, .005087399945868984, .008686092947757285);
  TriangleMesh mesh = face;
  mesh.faces.assign(100, face.faces[0]);
  const MeshQuery query(mesh);
  const ClosestPoint closest = query.closest_point(point);
  CHECK(closest.face == 0);
  CHECK(closest.squared_distance >= query.box().squaredExteriorDistance(point) * (1.0 - 0x1p-50));
}

TEST_CASE("Containment in a ball and a torus agrees with their equations",
          "[geometry][mesh_query]") {
  const MeshQuery sphere(ball(1.0, 4));
  const MeshQuery ring(torus(1.0, 0.4, 96, 48));
  Random random(32);
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d p = drawn(random, 1.5);
    // The polyhedra are inside the smooth bodies by at most 0.5 %.
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
  // The points are those of the lattice −2, −1.5, …, 2: rays along x run through edges, vertices
  // and faces.
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
  CHECK(query.first_hit({1, 0.25, 0.5}, {1, 0, 0})->distance == 0.0);  // It starts on the face.
}

TEST_CASE("No ray leaves a closed surface unnoticed", "[geometry][mesh_query]") {
  const TriangleMesh mesh = ball(1.0, 3);
  const MeshQuery query(mesh);
  Random random(34);
  const Eigen::Vector3d origin = drawn(random, 0.3);
  // The rays go straight at vertices and at the middles of edges, where two or six faces meet.
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
  mesh.faces = {{0, 1, 3}};  // These are collinear: the segment from 0 to 2.
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

namespace {

// Returns a triangle soup with whole coordinates in [−3, 3], some of it degenerate.
TriangleMesh whole_soup(Random& random, int num_faces) {
  TriangleMesh mesh;
  for (int i = 0; i < 3 * num_faces; ++i) {
    mesh.vertices.emplace_back(static_cast<double>(random.index(7)) - 3.0,
                               static_cast<double>(random.index(7)) - 3.0,
                               static_cast<double>(random.index(7)) - 3.0);
  }
  for (std::int32_t i = 0; i < num_faces; ++i) mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  return mesh;
}

// Returns where the line through `origin` along ±`axis` meets a closed triangle, in whole numbers,
// which doubles hold without rounding: by the sides of its edges in the plane across, then the
// height as a quotient. It is empty for triangles seen edge-on.
std::optional<double> exact_height(const std::array<Eigen::Vector3d, 3>& t,
                                   const Eigen::Vector3d& origin, int axis) {
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  std::array<double, 3> side;
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d a = t[(i + 1) % 3] - origin;
    const Eigen::Vector3d b = t[(i + 2) % 3] - origin;
    side[i] = a[u] * b[v] - a[v] * b[u];
    sum += side[i];
  }
  if (sum == 0.0) return std::nullopt;
  for (const double s : side) {
    if (s * sum < 0.0) return std::nullopt;
  }
  return (side[0] * t[0][axis] + side[1] * t[1][axis] + side[2] * t[2][axis]) / sum;
}

void check_weights(const Eigen::Vector3d& weights, const TriangleMesh& mesh, std::int32_t face,
                   const Eigen::Vector3d& point) {
  REQUIRE(weights.minCoeff() >= 0.0);
  REQUIRE(std::abs(weights.sum() - 1.0) < 1e-14);
  const auto [a, b, c] = corners(mesh, face);
  REQUIRE((weights[0] * a + weights[1] * b + weights[2] * c - point).norm() < 1e-12);
}

}  // namespace

TEST_CASE("All hits are those of whole-number arithmetic, edges and vertices included",
          "[geometry][mesh_query]") {
  Random random(36);
  int on_edges = 0;
  for (int round = 0; round < 40; ++round) {
    const TriangleMesh mesh = whole_soup(random, 30);
    const MeshQuery query(mesh);
    for (int i = 0; i < 40; ++i) {
      Eigen::Vector3d origin;
      for (double& x : origin) x = static_cast<double>(random.index(9)) - 4.0;
      const int axis = static_cast<int>(random.index(3));
      Eigen::Vector3d direction = Eigen::Vector3d::Zero();
      direction[axis] = random.index(2) == 0 ? 0.5 : -3.0;
      const double sign = direction[axis] > 0.0 ? 1.0 : -1.0;
      std::vector<std::pair<double, std::int32_t>> expected;
      for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        const auto height = exact_height(corners(mesh, face), origin, axis);
        if (height) expected.emplace_back(sign * (*height - origin[axis]), face);
      }
      for (const LineKind kind : {LineKind::Ray, LineKind::Line}) {
        const auto hits = query.all_hits(origin, direction, kind);
        std::vector<std::int32_t> found;
        for (const RayHit& hit : hits) {
          found.push_back(hit.face);
          check_weights(hit.barycentric, mesh, hit.face, hit.point);
          on_edges += hit.barycentric.minCoeff() == 0.0 ? 1 : 0;
          const auto match = std::find_if(expected.begin(), expected.end(),
                                          [&](const auto& e) { return e.second == hit.face; });
          REQUIRE(match != expected.end());
          CHECK(std::abs(hit.distance - match->first) < 1e-12);
        }
        CHECK(std::is_sorted(hits.begin(), hits.end(), [](const RayHit& a, const RayHit& b) {
          return a.distance != b.distance ? a.distance < b.distance : a.face < b.face;
        }));
        std::sort(found.begin(), found.end());
        std::vector<std::int32_t> wanted;
        for (const auto& [distance, face] : expected) {
          if (kind == LineKind::Line || distance >= 0.0) wanted.push_back(face);
        }
        CHECK(found == wanted);
        if (kind == LineKind::Line) continue;
        const auto first = query.first_hit(origin, direction);
        REQUIRE(first.has_value() == !hits.empty());
        if (first) CHECK(first->face == hits.front().face);
      }
    }
  }
  CHECK(on_edges > 1000);  // The hard cases do come up.
}

TEST_CASE("All hits of random lines are those of a loop over all faces", "[geometry][mesh_query]") {
  const TriangleMesh mesh = torus(1.0, 0.4, 20, 12);
  const MeshQuery query(mesh);
  Random random(37);
  std::size_t most = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d origin = drawn(random, 1.5);
    const Eigen::Vector3d direction = drawn(random, 1.0);
    std::vector<std::int32_t> expected;
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
      // By Cramer's rule origin + s·direction = a + u·(b − a) + v·(c − a).
      const auto [a, b, c] = corners(mesh, face);
      Eigen::Matrix3d m;
      m << b - a, c - a, -direction;
      const Eigen::Vector3d uvs = m.inverse() * (origin - a);
      if (uvs[0] >= 0 && uvs[1] >= 0 && uvs[0] + uvs[1] <= 1 && uvs[2] >= 0) {
        expected.push_back(static_cast<std::int32_t>(face));
      }
    }
    std::vector<std::int32_t> found;
    for (const RayHit& hit : query.all_hits(origin, direction)) {
      found.push_back(hit.face);
      check_weights(hit.barycentric, mesh, hit.face, hit.point);
    }
    std::sort(found.begin(), found.end());
    CHECK(found == expected);
    most = std::max(most, found.size());
  }
  CHECK(most >= 2);
}

TEST_CASE("A ray that all but runs along an axis finds what it runs into",
          "[geometry][mesh_query]") {
  // From a plane of the box the ray sinks so slowly that the inverse of the step overflows.
  const MeshQuery query(moved(box({1, 1, 2}), {0.5, -0.5, 0}));
  for (const double slow : {-1e-310, -0x1p-1074, -1e-300, -1e-20}) {
    CAPTURE(slow);
    const auto hits = query.all_hits({-1, 0, 0}, {1, slow, 0});
    REQUIRE_FALSE(hits.empty());
    CHECK(hits.front().distance == Approx(1.0).epsilon(1e-14));
    CHECK(hits.back().distance == Approx(2.0).epsilon(1e-14));
    int crossings = 0;
    for (const RayHit& hit : hits) crossings += hit.crossing;
    CHECK(crossings == 0);
    REQUIRE(query.first_hit({-1, 0, 0}, {1, slow, 0}));
    CHECK(query.first_hit({-1, 0, 0}, {1, slow, 0})->face == hits.front().face);
  }
}

TEST_CASE("A ray meets a face whose normal is lost in rounding where it is",
          "[geometry][mesh_query]") {
  // The corners are on a line but for their last digits, and the ray runs through the second.
  const MeshQuery query(
      one_face({Eigen::Vector3d(4.5, 6.3, 1.8), {1.5, 2.1, .6}, {3.0, 4.2, 1.2}}));
  const auto hit = query.first_hit({.5, 2.1, .6}, {1, 0, 0});
  REQUIRE(hit);
  CHECK(hit->distance == Approx(1.0).epsilon(1e-15));
  CHECK((hit->point - Eigen::Vector3d(1.5, 2.1, .6)).norm() < 1e-15);
}

TEST_CASE("However thin a face is, and seen however edge-on, a ray meets it where rationals say",
          "[geometry][mesh_query]") {
  using namespace graspfit::testing;
  Random random(40);
  int num_hits = 0;
  for (double thinness = 0.1; thinness > 1e-15; thinness *= 0.1) {
    for (int i = 0; i < 60; ++i) {
      CAPTURE(thinness, i);
      // Every other face is seen edge-on as nearly as it is thin.
      const double tilt = (i % 2 == 0 ? thinness : 1.0) * random.uniform();
      const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
      const Eigen::Vector3d up =
          Eigen::Vector3d(tilt, std::cos(angle), std::sin(angle)).normalized();
      const Eigen::Vector3d along = up.cross(drawn(random, 1.0)).normalized();
      const Eigen::Vector3d across = up.cross(along);
      const Eigen::Vector3d a = drawn(random, 0.5);
      const double place = random.uniform();
      const Triangle corners = {a, a + along, a + place * along + thinness * across};
      const Eigen::Vector3d target = 0.4 * corners[0] + 0.35 * corners[1] + 0.25 * corners[2];
      const Eigen::Vector3d origin(-3.0, target[1], target[2]);
      const auto hit = MeshQuery(one_face(corners)).first_hit(origin, {1, 0, 0});
      if (!hit) continue;  // Rounding has moved the target off the face.
      ++num_hits;
      // A line along the first axis is not turned by rounding the point ahead.
      const RationalPoint from = minus(exactly(origin), exactly(corners[0]));
      const RationalPoint normal = cross(minus(exactly(corners[1]), exactly(corners[0])),
                                         minus(exactly(corners[2]), exactly(corners[0])));
      const double exact = CGAL::to_double(Rational(-dot(from, normal) / normal[0]));
      // The origin is less than 5 from the face, and the face less than 1.5 long.
      CHECK(std::abs(hit->distance - exact) <= 2e-12 * 6.5);
    }
  }
  CHECK(num_hits > 300);
}

TEST_CASE("Crossings count each passage of a closed surface once", "[geometry][mesh_query]") {
  // With whole coordinates rays run along edges, in faces and through vertices of all three bodies.
  TriangleMesh octahedron;
  octahedron.vertices = {{3, 0, 0}, {-3, 0, 0}, {0, 3, 0}, {0, -3, 0}, {0, 0, 3}, {0, 0, -3}};
  octahedron.faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                      {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  const TriangleMesh cube = box({4, 4, 4});
  const TriangleMesh hollow = concatenated({cube, turned_inward(box({2, 2, 2}))});
  for (const TriangleMesh& mesh : {octahedron, cube, hollow}) {
    const MeshQuery query(mesh);
    for (int i = 0; i < 7 * 7 * 7; ++i) {
      const Eigen::Vector3d origin(i % 7 - 3, i / 7 % 7 - 3, i / 49 - 3);
      const bool is_inside = query.containment(origin) == Containment::Inside;
      const bool is_on = query.containment(origin) == Containment::OnSurface;
      for (const Eigen::Vector3d& direction : {Eigen::Vector3d(1, 0, 0),
                                               {-1, 0, 0},
                                               {0, 1, 0},
                                               {0, -1, 0},
                                               {0, 0, 1},
                                               {0, 0, -1},
                                               {1, 1, 0},
                                               {1, -1, 1},
                                               {2, 1, 0.5}}) {
        const auto sum = [&](LineKind kind) {
          int crossings = 0;
          for (const RayHit& hit : query.all_hits(origin, direction, kind)) {
            crossings += hit.crossing;
          }
          return crossings;
        };
        CHECK(sum(LineKind::Line) == 0);
        if (!is_on) CHECK(sum(LineKind::Ray) == (is_inside ? 1 : 0));
      }
    }
  }
  // Through the middle of a cube both triangles of a side are met on their common edge, and one
  // counts.
  const auto hits = MeshQuery(cube).all_hits({-5, 0, 0}, {1, 0, 0});
  CHECK(hits.size() == 4);
  CHECK(std::abs(hits[0].crossing + hits[1].crossing) == 1);
}

TEST_CASE("The closest point is the same whichever face is looked at first",
          "[geometry][mesh_query]") {
  Random random(39);
  // Points of a lattice through the cube's planes of symmetry are equally near many faces.
  for (const TriangleMesh& mesh :
       {torus(1.0, 0.4, 14, 9), box({2, 2, 2}), whole_soup(random, 60)}) {
    const MeshQuery query(mesh);
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d drawn_point = drawn(random, 2.0);
      const Eigen::Vector3d point = i % 2 == 0 ? drawn_point : drawn_point.array().round().matrix();
      const ClosestPoint expected = query.closest_point(point);
      const auto size = static_cast<std::int32_t>(mesh.faces.size());
      for (std::int32_t first = 0; first < size; first += 7) {
        const ClosestPoint found = query.closest_point(point, first);
        REQUIRE(found.face == expected.face);
        REQUIRE(found.point == expected.point);
        REQUIRE(found.barycentric == expected.barycentric);
        REQUIRE(found.squared_distance == expected.squared_distance);
      }
    }
  }
  const MeshQuery cube(box({2, 2, 2}));
  CHECK_THROWS_WITH(cube.closest_point({0, 0, 0}, 12),
                    "MeshQuery::closest_point: first = 12, must be >= 0 and less than the number "
                    "of faces");
  CHECK_THROWS_AS(cube.closest_point({0, 0, 0}, -1), InvalidInput);
}

TEST_CASE("Closest points have the weights of their face's corners", "[geometry][mesh_query]") {
  Random random(38);
  const TriangleMesh soup = whole_soup(random, 60);
  const MeshQuery query(soup);
  for (int i = 0; i < 500; ++i) {
    const ClosestPoint closest = query.closest_point(drawn(random, 5.0));
    check_weights(closest.barycentric, soup, closest.face, closest.point);
  }
}

TEST_CASE("All hits refuse what first_hit refuses", "[geometry][mesh_query]") {
  const MeshQuery query(box({1, 1, 1}));
  CHECK_THROWS_WITH(query.all_hits({0, 0, 0}, {0, 0, 0}),
                    "MeshQuery::all_hits: the direction has no length");
  CHECK_THROWS_AS(query.all_hits({std::nan(""), 0, 0}, {1, 0, 0}), InvalidInput);
  CHECK(query.all_hits({5, 5, 5}, {0, 0, 1}).empty());
}

}  // namespace test_mesh_query
