#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/squared_distance_3.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "geometry/rational_distance.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/mesh_intersection.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/surface_proximity.hpp"
#include "support/catch.hpp"

namespace test_surface_proximity {

using namespace graspfit::base;
using namespace graspfit::geometry;

namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

RigidTransform drawn_pose(Random& random, double size) {
  Eigen::Vector4d q;
  for (double& x : q) x = random.uniform(-1.0, 1.0);
  RigidTransform X(Eigen::Quaterniond(q).normalized());
  for (double& x : X.translation()) x = random.uniform(-size, size);
  return X;
}

}  // namespace

TEST_CASE("Nearest points agree with the distance of solids that are apart",
          "[geometry][surface_proximity]") {
  const MeshQuery a(torus(1.0, 0.3, 24, 12));
  const MeshQuery b(box({0.5, 0.2, 0.9}));
  Random random(5);
  int num_apart = 0;
  int num_crossing = 0;
  for (int i = 0; i < 200; ++i) {
    const RigidTransform X_AB = drawn_pose(random, 1.6);
    const auto nearest = nearest_points(a, b, X_AB, kNoLimit);
    REQUIRE(nearest);
    if (do_intersect(a, b, X_AB)) {
      ++num_crossing;
      // Neither is small enough to be inside the other.
      CHECK(nearest->distance == 0.0);
      continue;
    }
    ++num_apart;
    // These are two constructions of the same length; coordinates of about 2 are rounded some ten
    // times.
    CHECK(nearest->distance == Approx(distance(a, b, X_AB).distance).margin(1e-14));
    CHECK((nearest->point_on_a_A - nearest->point_on_b_A).norm() ==
          Approx(nearest->distance).margin(1e-15));
    CHECK(a.closest_point(nearest->point_on_a_A).squared_distance < 1e-28);
    CHECK(b.closest_point(X_AB.inverse() * nearest->point_on_b_A).squared_distance < 1e-28);
    // A seed, even a bad one, changes nothing.
    const auto seeded = nearest_points(a, b, X_AB, kNoLimit, ProximitySeed{i % 100, i % 12});
    REQUIRE(seeded);
    CHECK(seeded->distance == Approx(nearest->distance).margin(1e-15));
    // Any pair within a limit is allowed, but there must be one exactly where there is a nearer
    // one.
    const auto any = nearest_points(a, b, X_AB, kNoLimit, {}, 1.5 * nearest->distance);
    REQUIRE(any);
    CHECK(any->distance <= 1.5 * nearest->distance);
    CHECK(any->distance >= nearest->distance - 1e-15);
    // Neither does one that is farther away than the limit.
    for (const std::optional<ProximitySeed>& seed :
         {std::optional<ProximitySeed>(), std::optional(ProximitySeed{i % 100, i % 12})}) {
      CHECK_FALSE(nearest_points(a, b, X_AB, 0.999 * nearest->distance, seed));
      const auto limited = nearest_points(a, b, X_AB, 1.001 * nearest->distance + 1e-12, seed);
      REQUIRE(limited);
      CHECK(limited->distance == Approx(nearest->distance).margin(1e-15));
    }
  }
  CHECK(num_apart > 50);
  CHECK(num_crossing > 40);
}

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// A face as CGAL's triangle, and a ball about it.
struct Face {
  Kernel::Triangle_3 triangle;
  Eigen::Vector3d center;
  double radius = 0.0;
};

std::vector<Face> faces_of(const TriangleMesh& mesh, const RigidTransform& X) {
  std::vector<Face> faces;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    Face face;
    std::array<Kernel::Point_3, 3> points;
    const std::array<Eigen::Vector3d, 3> corners_B = corners(mesh, f);
    face.center = X * Eigen::Vector3d((corners_B[0] + corners_B[1] + corners_B[2]) / 3.0);
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d corner = X * corners_B[i];
      points[i] = {corner.x(), corner.y(), corner.z()};
      face.radius = std::max(face.radius, (corner - face.center).norm());
    }
    face.triangle = {points[0], points[1], points[2]};
    faces.push_back(face);
  }
  return faces;
}

/// The distance of two surfaces, from all pairs of their faces.
double distance_of_all_pairs(const TriangleMesh& a, const TriangleMesh& b,
                             const RigidTransform& X_AB) {
  const std::vector<Face> faces_a = faces_of(a, RigidTransform::Identity());
  const std::vector<Face> faces_b = faces_of(b, X_AB);
  double least = kNoLimit;
  for (const Face& f : faces_a) {
    for (const Face& g : faces_b) {
      if ((f.center - g.center).norm() - f.radius - g.radius > least) continue;
      least = std::min(least, std::sqrt(CGAL::squared_distance(f.triangle, g.triangle)));
    }
  }
  return least;
}

}  // namespace

TEST_CASE("Round surfaces that nearly touch anywhere are as far apart as all pairs of their faces",
          "[geometry][surface_proximity]") {
  // Most small parts of fine meshes are nearly flat, at all angles to the axes.
  const MeshQuery a(torus(1.0, 0.3, 64, 32));
  const MeshQuery b(ball(0.4, 3));
  Random random(8);
  int num_near = 0;
  for (int i = 0; i < 80; ++i) {
    RigidTransform X_AB = drawn_pose(random, 1.2);
    if (do_intersect(a, b, X_AB)) continue;
    const auto away = nearest_points(a, b, X_AB, kNoLimit);
    REQUIRE(away);
    const Eigen::Vector3d way = away->point_on_a_A - away->point_on_b_A;
    X_AB.pretranslate((1.0 - 1e-3 / away->distance) * way);
    if (do_intersect(a, b, X_AB)) continue;
    ++num_near;
    const double expected = distance_of_all_pairs(a.mesh(), b.mesh(), X_AB);
    CHECK(expected <= 1.001e-3);
    for (const std::optional<ProximitySeed>& seed :
         {std::optional<ProximitySeed>(),
          std::optional(ProximitySeed{away->face_a, away->face_b})}) {
      const auto nearest = nearest_points(a, b, X_AB, kNoLimit, seed);
      REQUIRE(nearest);
      CHECK(nearest->distance == Approx(expected).margin(1e-13));
      CHECK(surface_clearance(a, b, X_AB, kNoLimit, 1.0, seed).at_least ==
            Approx(expected).margin(1e-11));
      const double half = surface_clearance(a, b, X_AB, kNoLimit, 0.5, seed).at_least;
      CHECK(half <= expected + 1e-11);
      CHECK(half >= 0.5 * expected);
      CHECK_FALSE(nearest_points(a, b, X_AB, 0.999 * expected, seed));
    }
  }
  CHECK(num_near > 30);
}

TEST_CASE("A pose written with three digits gives the distance of the mesh moved by it",
          "[geometry][surface_proximity]") {
  // The inverse of such a matrix is not its transpose: boxes seen along its columns are off by a
  // thousandth, more than the distances of many pairs of faces differ.
  const MeshQuery a(ball(1.0, 3));
  const TriangleMesh other = torus(1.0, 0.3, 48, 24);
  const MeshQuery b(other);
  Random random(12);
  int num_apart = 0;
  for (int i = 0; i < 200; ++i) {
    RigidTransform X_AB = drawn_pose(random, 3.0);
    X_AB.linear() = (X_AB.linear().array() * 1e3).round() / 1e3;
    const MeshQuery moved(transformed(other, X_AB));
    const RigidTransform at = RigidTransform::Identity();
    const auto nearest = nearest_points(a, b, X_AB, kNoLimit);
    const auto expected = nearest_points(a, moved, at, kNoLimit);
    REQUIRE((nearest && expected));
    num_apart += expected->distance > 0.0 ? 1 : 0;
    INFO("pose " << i);
    CHECK(nearest->distance == Approx(expected->distance).margin(1e-14));
    const double clearance = surface_clearance(a, b, X_AB, kNoLimit, 1.0).at_least;
    CHECK(clearance <= expected->distance + 1e-12);
    CHECK(clearance >= expected->distance - 1e-12);
  }
  CHECK(num_apart > 100);
}

TEST_CASE("A matrix that is nearly a rotation lengthens no lower bound",
          "[geometry][surface_proximity]") {
  // Along the columns of this matrix the two points seem to be farther apart than they are, by
  // 1.38e-12 of their distance.
  RigidTransform X_AB = RigidTransform::Identity();
  X_AB.linear().array() += 4.9e-13;
  X_AB.linear().diagonal().setConstant(1.0 + 4e-13);
  TriangleMesh point;
  point.vertices = {{0, 0, 0}, {1, 1, 1}};
  point.faces = {{0, 0, 0}};
  const MeshQuery a(point);
  point.faces = {{1, 1, 1}};
  const MeshQuery b(point);
  const double distance = (X_AB * point.vertices[1]).norm();
  // What is farther than a limit is left out; 1e-12 of the coordinates is what bounds may be off.
  const SurfaceClearance found = surface_clearance(a, b, X_AB, distance + 2e-12, 1.0);
  CHECK(found.at_least <= distance + 1e-12);
  CHECK(found.at_least >= distance - 1e-12);
}

TEST_CASE("A sliver whose area is nearly zero hides no nearest point",
          "[geometry][surface_proximity]") {
  // The squares of its cross product's components, about 1.5e-162, underflow: divided by the root
  // of their sum it would be a fifth too long, and so would heights above it.
  const Eigen::Vector3d normal = Eigen::Vector3d(1.5, 1.5, 1.6).normalized();
  const Eigen::Vector3d along(0.1, -0.1, 0);
  const Eigen::Vector3d point = 0.5 * along + 0.01 * normal;
  TriangleMesh slivers;
  slivers.vertices = {Eigen::Vector3d::Zero(), along, 5e-161 * Eigen::Vector3d(0.16, 0.16, -0.3),
                      point + Eigen::Vector3d(0, 0, 0.011)};
  slivers.faces = {{0, 1, 2}, {0, 1, 1}, {0, 1, 1}, {0, 1, 1}, {3, 3, 3}, {3, 3, 3}};
  TriangleMesh other;
  other.vertices = {point};
  other.faces = {{0, 0, 0}};
  const RigidTransform at = RigidTransform::Identity();
  const auto nearest = nearest_points(MeshQuery(other), MeshQuery(slivers), at, kNoLimit);
  REQUIRE(nearest);
  CHECK(nearest->distance == Approx(0.01).margin(1e-14));
  CHECK(nearest->face_b < 4);
}

TEST_CASE("A surface inside another has a distance from it", "[geometry][surface_proximity]") {
  const MeshQuery outer(box({2, 2, 2}));
  const MeshQuery inner(box({1, 1, 1}));
  RigidTransform X = RigidTransform::Identity();
  X.translation() = Eigen::Vector3d(0.25, 0, 0);
  const auto nearest = nearest_points(outer, inner, X, kNoLimit);
  REQUIRE(nearest);
  CHECK(nearest->distance == Approx(0.25).margin(1e-15));  // It is 1 − (0.5 + 0.25).
}

TEST_CASE("A seed that is not of the meshes is refused", "[geometry][surface_proximity]") {
  const MeshQuery a(box({2, 2, 2}));  // of twelve faces
  const RigidTransform at = RigidTransform::Identity();
  for (const ProximitySeed& seed :
       {ProximitySeed{-1, 0}, ProximitySeed{0, -1}, ProximitySeed{12, 0}, ProximitySeed{0, 12}}) {
    CHECK_THROWS_AS(nearest_points(a, a, at, kNoLimit, seed), InvalidInput);
    CHECK_THROWS_AS(surface_clearance(a, a, at, kNoLimit, 1.0, seed), InvalidInput);
  }
}

TEST_CASE("An open surface pierced in its middle is at distance zero",
          "[geometry][surface_proximity]") {
  TriangleMesh sheet;
  sheet.vertices = {{-9, -9, 0.01}, {9, -9, 0.01}, {0, 9, 0.01}};
  sheet.faces = {{0, 1, 2}};
  const MeshQuery needle(box({0.1, 0.1, 2}));
  const auto nearest =
      nearest_points(MeshQuery(sheet), needle, RigidTransform::Identity(), kNoLimit);
  REQUIRE(nearest);
  CHECK(nearest->distance == 0.0);
  CHECK(nearest->face_a == 0);
}

namespace {

using graspfit::testing::Triangle;

Eigen::Vector3d drawn_direction(Random& random) { return drawn_pose(random, 0.0).linear().col(0); }

MeshQuery one_face(const Triangle& corners) {
  TriangleMesh mesh;
  mesh.vertices.assign(corners.begin(), corners.end());
  mesh.faces = {{0, 1, 2}};
  return MeshQuery(mesh);
}

// A face beside which rounding matters most.
enum class Beside {
  Corner,  // With a corner over a corner or the middle of the thin face.
  Edge,    // With an edge along an edge of the thin face, at an angle as small as it is thin.
  Tip      // A needle through the thin face.
};

struct PairOfFaces {
  Triangle thin;
  Triangle other;
};

// Two faces with edges of about 0.1 m that are apart by about `gap`, or cross.
PairOfFaces drawn_pair(Random& random, Beside beside, double thinness, double gap) {
  const Eigen::Vector3d along = drawn_direction(random);
  const Eigen::Vector3d across = along.cross(drawn_direction(random)).normalized();
  const Eigen::Vector3d up = along.cross(across);
  const Eigen::Vector3d start = 0.05 * drawn_direction(random);
  // The third corner is over the middle of the long edge, or near one of its ends.
  const std::array<double, 3> places = {random.uniform(), thinness * random.uniform(),
                                        1.0 - thinness * random.uniform()};
  PairOfFaces result;
  result.thin = {start, start + 0.1 * along,
                 start + 0.1 * (places[random.index(3)] * along + thinness * across)};
  const auto& [a, b, c] = result.thin;
  if (beside == Beside::Corner) {
    const Eigen::Vector3d middle = 0.3 * a + 0.3 * b + 0.4 * c;
    const Eigen::Vector3d aside = gap * drawn_direction(random);
    const bool is_over_corner = random.index(2) == 0;
    const Eigen::Vector3d place = (is_over_corner ? result.thin[random.index(3)] : middle) + aside;
    result.other = {place, place + 0.1 * drawn_direction(random),
                    place + 0.07 * drawn_direction(random)};
  } else if (beside == Beside::Edge) {
    const Eigen::Vector3d place = a + 0.3 * (b - a) + gap * up;
    const Eigen::Vector3d direction = along + 0.01 * thinness * drawn_direction(random);
    result.other = {place - 0.03 * direction, place + 0.05 * direction, place + 0.05 * up};
  } else {
    const Eigen::Vector3d place = 0.4 * a + 0.35 * b + 0.25 * c + gap * up;
    const Eigen::Vector3d direction = drawn_direction(random);
    const Eigen::Vector3d end = place - 0.04 * direction;
    result.other = {place + 0.05 * direction, end, end + 0.01 * thinness * up};
  }
  std::rotate(result.thin.begin(), result.thin.begin() + random.index(3), result.thin.end());
  std::rotate(result.other.begin(), result.other.begin() + random.index(3), result.other.end());
  return result;
}

}  // namespace

TEST_CASE("However thin faces are, their distance is that in rationals",
          "[geometry][surface_proximity]") {
  using namespace graspfit::testing;
  constexpr double kBound = 1e-12 * 0.2;  // No coordinate is larger than 0.2.
  Random random(13);
  int num_crossing = 0;
  for (const Beside beside : {Beside::Corner, Beside::Edge, Beside::Tip}) {
    for (const double thinness : {0.5, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14}) {
      for (int i = 0; i < 40; ++i) {
        CAPTURE(static_cast<int>(beside), thinness, i);
        const double gap = std::array{0.0, 1e-12, 1e-9, 1e-6}[i % 4];
        const auto [thin, other] = drawn_pair(random, beside, thinness, gap);
        const double exact =
            rounded_root(squared_distance_of_triangles(exactly(thin), exactly(other)));
        num_crossing += exact == 0.0 ? 1 : 0;
        const MeshQuery a = one_face(thin);
        const MeshQuery b = one_face(other);
        const RigidTransform at = RigidTransform::Identity();
        // A near limit leaves out what rounding puts beyond it.
        for (const double enough : {kNoLimit, exact + 1e-8, exact + 2.0 * kBound}) {
          CAPTURE(enough);
          const auto found = nearest_points(a, b, at, enough);
          REQUIRE(found);
          CHECK(std::abs(found->distance - exact) <= kBound);
          const double at_least = surface_clearance(a, b, at, enough, 1.0).at_least;
          CHECK(std::abs(at_least - exact) <= kBound);
        }
      }
    }
  }
  CHECK(num_crossing > 50);
}

}  // namespace test_surface_proximity
