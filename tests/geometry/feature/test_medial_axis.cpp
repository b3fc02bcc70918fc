#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/medial_axis.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

namespace test_medial_axis {

using namespace graspfit::base;
using namespace graspfit::geometry;

namespace {

// Checks what is true of every ball, whatever the body.
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

// Returns the middle of every face as a sample.
std::vector<SurfaceSample> face_centers(const TriangleMesh& mesh) {
  std::vector<SurfaceSample> samples;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const auto [a, b, c] = corners(mesh, face);
    samples.push_back({(a + b + c) / 3.0, face_normal(mesh, face), static_cast<int>(face),
                       Eigen::Vector3d::Constant(1.0 / 3.0)});
  }
  return samples;
}

// Returns a closed body that looks the same from nowhere: bumps, dents and noise on a ball. Each
// point of it is seen from the origin, so that its faces do not cross.
TriangleMesh dented_ball() {
  TriangleMesh mesh = ball(0.05, 3);
  Random random(8);
  for (Eigen::Vector3d& v : mesh.vertices) {
    const Eigen::Vector3d u = v.normalized();
    const double bumps = std::sin(3.0 * u[0] + 1.0) * std::cos(4.0 * u[1]) + 0.5 * u[2] * u[0];
    v *= 1.0 + 0.3 * bumps + random.uniform(-0.01, 0.01);
  }
  return mesh;
}

Eigen::Vector3d nearest_on_segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                   const Eigen::Vector3d& x) {
  return a + std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0) * (b - a);
}

// Finds the nearest point without the tree that the balls are found with: the foot of the
// perpendicular if it is in the triangle, else the nearest point of the edges.
Eigen::Vector3d nearest_on_face(const TriangleMesh& mesh, std::size_t face,
                                const Eigen::Vector3d& x) {
  const auto c = corners(mesh, face);
  const Eigen::Vector3d normal = face_normal(mesh, face);
  const Eigen::Vector3d foot = x - normal.dot(x - c[0]) * normal;
  bool is_within = true;
  Eigen::Vector3d nearest = c[0];
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d& a = c[k];
    const Eigen::Vector3d& b = c[(k + 1) % 3];
    is_within = is_within && normal.dot((b - a).cross(foot - a)) >= 0.0;
    const Eigen::Vector3d on_edge = nearest_on_segment(a, b, x);
    if ((on_edge - x).squaredNorm() < (nearest - x).squaredNorm()) nearest = on_edge;
  }
  return is_within ? foot : nearest;
}

// Returns the radius of the ball that touches at the sample from inside and goes through q;
// infinite if there is none.
double tangent_radius(const SurfaceSample& sample, const Eigen::Vector3d& q) {
  const Eigen::Vector3d to_sample = sample.point - q;
  const double rise = sample.normal.dot(to_sample);
  return rise > 0.0 ? 0.5 * to_sample.squaredNorm() / rise
                    : std::numeric_limits<double>::infinity();
}

// Balls that touch at the sample lie one in the other, so that one face after the other cuts the
// largest one down, by bisection to where it only touches the face.
double largest_empty_radius(const TriangleMesh& mesh, const SurfaceSample& sample) {
  double radius = 0.2;  // No ball is larger than the body's diagonal.
  const auto meets = [&](std::size_t face, double r) {
    const Eigen::Vector3d center = sample.point - r * sample.normal;
    return (nearest_on_face(mesh, face, center) - center).norm() < r * (1.0 - 1e-12);
  };
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    if (static_cast<int>(face) == sample.face || !meets(face, radius)) continue;
    double empty = 0.0;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (empty + radius);
      (meets(face, middle) ? radius : empty) = middle;
    }
  }
  return radius;
}

// Returns the same among points, by the formula; the points on the sample's own face are no bound.
double largest_radius_among(const std::vector<Eigen::Vector3d>& points,
                            const SurfaceSample& sample) {
  double radius = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& q : points) {
    if (sample.normal.dot(sample.point - q) < 1e-15) continue;
    radius = std::min(radius, tangent_radius(sample, q));
  }
  return radius;
}

}  // namespace

TEST_CASE("Balls of a long cylinder are centered on its axis", "[geometry][medial_axis]") {
  const double radius = 0.01;
  const MeshQuery bar(cylinder(radius, 0.3, 96));
  const auto balls = medial_balls(bar, sample_surface(bar.mesh(), {.count = 800, .seed = 1}));
  check_balls(bar, balls, 0.05);
  CHECK(balls.size() > 700);
  for (const MedialBall& ball : balls) {
    // Half a facet, 3.3 % of the radius, is between a sample and the middle of its facet.
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
    // The sample is on a large side, a radius or more away from the small ones; nearer, the small
    // side stops the ball at 90°. Within the tolerance either may come first.
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

TEST_CASE("On an irregular body each ball is the largest empty one, by search over all faces",
          "[geometry][medial_axis]") {
  const TriangleMesh mesh = dented_ball();
  const MeshQuery body(mesh);
  const auto samples = sample_surface(mesh, {.count = 250, .seed = 4});
  // The balls are strictly empty, whatever their angle.
  const auto balls =
      medial_balls(body, samples, {.min_object_angle_deg = 0.0, .emptiness_tolerance = 1e-9});
  REQUIRE(balls.size() > samples.size() * 85 / 100);
  std::vector<Eigen::Vector3d> surface_points;
  for (const MedialBall& ball : balls) {
    surface_points.insert(surface_points.end(), ball.contacts.begin(), ball.contacts.end());
  }
  int num_far = 0;
  int num_vanished = 0;
  std::size_t next = 0;
  for (const MedialBall& ball : balls) {
    while (samples.at(next).point != ball.contacts[0]) ++next;
    const SurfaceSample& sample = samples[next];
    // A ball at rest touches at the sample, too; where rounding takes that for an intrusion, the
    // ball shrinks to nothing.
    if (ball.radius < 1e-12) {
      ++num_vanished;
      continue;
    }
    REQUIRE((ball.center - (sample.point - ball.radius * sample.normal)).norm() < 1e-15);
    // How deep a face is in a ball grows with the radius at the rate 1 − cos(angle): by so much the
    // radius's error is larger than the tolerance.
    const double angle = ball.object_angle_deg * std::acos(-1.0) / 180.0;
    const double slack = 1e-9 + 3e-9 / (1.0 - std::cos(angle));
    REQUIRE(ball.radius == Approx(largest_empty_radius(mesh, sample)).epsilon(slack));
    REQUIRE(ball.radius == Approx(largest_radius_among(surface_points, sample)).epsilon(slack));
    if (ball.object_angle_deg > 120.0) ++num_far;
  }
  CHECK(num_vanished < 5);
  CHECK(num_far > 10);  // Not all are stopped beside the sample.
  // Not all are stopped by the other side either.
  CHECK(num_far < static_cast<int>(balls.size()) * 9 / 10);
}

TEST_CASE("With a tolerance no ball is smaller than the empty one, nor deeper than said",
          "[geometry][medial_axis]") {
  const TriangleMesh mesh = dented_ball();
  const MeshQuery body(mesh);
  const auto samples = sample_surface(mesh, {.count = 250, .seed = 4});
  const double tolerance = 0.05;
  const auto balls =
      medial_balls(body, samples, {.min_object_angle_deg = 0.0, .emptiness_tolerance = tolerance});
  REQUIRE(balls.size() > samples.size() / 2);
  std::size_t next = 0;
  int num_larger = 0;
  for (const MedialBall& ball : balls) {
    while (samples.at(next).point != ball.contacts[0]) ++next;
    const SurfaceSample& sample = samples[next];
    const double strict = largest_empty_radius(mesh, sample);
    REQUIRE(ball.radius >= strict * (1.0 - 1e-6));
    if (ball.radius > strict * 1.01) ++num_larger;
    double deepest = 0.0;
    double radius_there = ball.radius;
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
      const Eigen::Vector3d q = nearest_on_face(mesh, face, ball.center);
      const double depth = ball.radius - (q - ball.center).norm();
      if (depth <= deepest) continue;
      deepest = depth;
      radius_there = tangent_radius(sample, q);
    }
    // What intrudes by rounding may be beside the sample.
    REQUIRE(deepest <= tolerance * radius_there * (1.0 + 1e-9) + 1e-15);
  }
  CHECK(num_larger > 10);  // The tolerance does let balls pass facets beside the sample.
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

}  // namespace test_medial_axis
