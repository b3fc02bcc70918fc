#include <cmath>

#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/medial_axis.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

using namespace graspfit::geometry;

namespace {

// What is true of every ball, whatever the body.
void check_balls(const MeshQuery& object, const std::vector<MedialBall>& balls, double tolerance) {
  REQUIRE_FALSE(balls.empty());
  for (const MedialBall& ball : balls) {
    REQUIRE(object.containment(ball.center) == Containment::Inside);
    const double distance = std::sqrt(object.closest_point(ball.center).squared_distance);
    REQUIRE(distance >= ball.radius * (1.0 - tolerance) * (1.0 - 1e-12));
    for (int i = 0; i < 2; ++i) {
      REQUIRE((ball.contacts[i] - ball.center).norm() == Approx(ball.radius).epsilon(1e-9));
      TriangleMesh face = object.mesh();
      face.faces = {face.faces.at(ball.contact_faces[i])};
      REQUIRE(MeshQuery(face).closest_point(ball.contacts[i]).squared_distance <
              1e-18 * ball.radius * ball.radius);
    }
    const Eigen::Vector3d u = (ball.contacts[0] - ball.center).normalized();
    const Eigen::Vector3d v = (ball.contacts[1] - ball.center).normalized();
    REQUIRE(std::cos(ball.object_angle_deg * std::acos(-1.0) / 180.0) ==
            Approx(u.dot(v)).margin(1e-9));
    REQUIRE(ball.object_angle_deg > 120.0);
  }
}

// The middle of every face as a sample.
std::vector<SurfaceSample> face_centers(const TriangleMesh& mesh) {
  std::vector<SurfaceSample> samples;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const auto [a, b, c] = corners(mesh, face);
    samples.push_back({(a + b + c) / 3.0, face_normal(mesh, face), static_cast<int>(face),
                       Eigen::Vector3d::Constant(1.0 / 3.0)});
  }
  return samples;
}

}  // namespace

TEST_CASE("Balls of a long cylinder are centered on its axis", "[geometry][medial_axis]") {
  const double radius = 0.01;
  const MeshQuery bar(cylinder(radius, 0.3, 96));
  const auto balls = medial_balls(bar, sample_surface(bar.mesh(), {.count = 800, .seed = 1}));
  check_balls(bar, balls, 0.05);
  CHECK(balls.size() > 700);
  for (const MedialBall& ball : balls) {
    // Half a facet, 3.3 % of the radius, lies between a sample and the middle of its facet.
    CHECK(std::hypot(ball.center[0], ball.center[1]) < 0.07 * radius);
    CHECK(ball.radius == Approx(radius).epsilon(0.05));
    CHECK(ball.object_angle_deg > 150.0);
  }
}

TEST_CASE("Balls of a square bar sampled on its midlines have its axis and its half width",
          "[geometry][medial_axis]") {
  const MeshQuery bar(box({0.02, 0.02, 0.4}));
  std::vector<SurfaceSample> midline;
  for (int i = -15; i <= 15; ++i) {
    const Eigen::Vector3d p(0.01, 0.0, 0.01 * i);
    midline.push_back({p, {1, 0, 0}, bar.closest_point(p).face, bar.closest_point(p).barycentric});
  }
  const auto balls = medial_balls(bar, midline, {.emptiness_tolerance = 1e-9});
  CHECK(balls.size() == midline.size());
  for (const MedialBall& ball : balls) {
    CHECK(ball.center.head<2>().norm() < 1e-11);
    CHECK(ball.radius == Approx(0.01).epsilon(1e-9));
  }
}

TEST_CASE("The balls of a ball are all the ball itself", "[geometry][medial_axis]") {
  const MeshQuery sphere(ball(0.05, 4));
  const auto balls = medial_balls(sphere, face_centers(sphere.mesh()));
  check_balls(sphere, balls, 0.05);
  CHECK(balls.size() > sphere.mesh().faces.size() * 9 / 10);
  for (const MedialBall& ball : balls) {
    CHECK(ball.center.norm() < 0.03 * 0.05);
    CHECK(ball.radius == Approx(0.05).epsilon(0.03));
  }
}

TEST_CASE("The centers of a torus lie on the circle in its tube", "[geometry][medial_axis]") {
  const double major = 0.1;
  const double minor = 0.03;
  const MeshQuery ring(torus(major, minor, 192, 96));
  const auto balls = medial_balls(ring, sample_surface(ring.mesh(), {.count = 600, .seed = 2}));
  check_balls(ring, balls, 0.05);
  CHECK(balls.size() > 550);
  for (const MedialBall& ball : balls) {
    const double off =
        std::hypot(std::hypot(ball.center[0], ball.center[1]) - major, ball.center[2]);
    CHECK(off < 0.07 * minor);
    CHECK(ball.radius == Approx(minor).epsilon(0.05));
  }
}

TEST_CASE("A flat box has its middle plane, and nothing near its rim", "[geometry][medial_axis]") {
  const MeshQuery plate(box({10, 8, 1}));
  const auto samples = sample_surface(plate.mesh(), {.count = 1000, .seed = 3});
  const auto balls = medial_balls(plate, samples);
  check_balls(plate, balls, 0.05);
  std::size_t expected = 0;
  for (const SurfaceSample& sample : samples) {
    // On a large side, a radius or more away from the small ones; nearer, the small side stops the
    // ball at 90°. Within the tolerance either may come first.
    const double inside =
        std::min(5.0 - std::abs(sample.point[0]), 4.0 - std::abs(sample.point[1]));
    if (std::abs(sample.normal[2]) > 0.5 && inside > 0.5) ++expected;
  }
  CHECK(balls.size() >= expected);
  CHECK(balls.size() <= expected + 60);
  for (const MedialBall& ball : balls) {
    CHECK(std::abs(ball.center[2]) < 1e-9);
    CHECK(ball.radius == Approx(0.5));
    CHECK(ball.object_angle_deg == Approx(180.0));
  }
}

TEST_CASE("The radius filter keeps the large of two parts", "[geometry][medial_axis]") {
  TriangleMesh far = ball(0.01, 3);
  for (auto& vertex : far.vertices) vertex += Eigen::Vector3d(1, 0, 0);
  const MeshQuery both(concatenated({ball(0.05, 3), far}));
  const auto samples = face_centers(both.mesh());
  const auto all = medial_balls(both, samples, {.num_threads = 1});
  const auto large = medial_balls(both, samples, {.min_radius_rel = 0.5, .num_threads = 3});
  CHECK(large.size() < all.size());
  CHECK_FALSE(large.empty());
  for (const MedialBall& ball : large) CHECK(ball.center.norm() < 0.05);
}

TEST_CASE("Samples beside the mesh and bad options of balls are refused",
          "[geometry][medial_axis]") {
  const MeshQuery cube(box({1, 1, 1}));
  std::vector<SurfaceSample> samples = face_centers(cube.mesh());
  CHECK(medial_balls(cube, {}).empty());
  CHECK_THROWS_AS(medial_balls(cube, samples, {.min_object_angle_deg = 181}), InvalidInput);
  CHECK_THROWS_AS(medial_balls(cube, samples, {.min_radius_rel = -0.1}), InvalidInput);
  CHECK_THROWS_AS(medial_balls(cube, samples, {.emptiness_tolerance = 0.0}), InvalidInput);
  samples[3].normal *= 2.0;
  CHECK_THROWS_WITH(medial_balls(cube, samples),
                    "medial_balls: a sample's point must be finite and its normal unit");
  samples[3].normal.setZero();
  CHECK_NOTHROW(medial_balls(cube, samples));
  samples[3].face = 12;
  CHECK_THROWS_WITH(medial_balls(cube, samples), "medial_balls: a sample is on face 12 of 12");
}
