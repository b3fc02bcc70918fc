#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/shape_diameter.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

namespace test_shape_diameter {

using namespace graspfit::base;
using namespace graspfit::geometry;
using std::numbers::pi;

namespace {

// Returns what the recipe gives for a body whose ray length at angle `theta` from the inward normal
// and `phi` around it is known (negative: it meets a face that is turned less than 90° from its
// own): over a dense uniform cone, the mean within one standard deviation of the median.
double expected_thickness(const std::function<double(double theta, double phi)>& length) {
  std::vector<double> lengths;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    // The cosines are uniform in [½, 1].
    const double theta = std::acos(1.0 - 0.5 * (i + 0.5) / kSteps);
    for (int j = 0; j < kSteps; ++j) {
      const double l = length(theta, 2 * pi * (j + 0.5) / kSteps);
      if (l >= 0.0) lengths.push_back(l);
    }
  }
  std::sort(lengths.begin(), lengths.end());
  const double median = lengths[lengths.size() / 2];
  double sum = 0.0;
  double squares = 0.0;
  for (const double l : lengths) {
    sum += l;
    squares += l * l;
  }
  const double n = static_cast<double>(lengths.size());
  const double deviation = std::sqrt(squares / n - sum / n * sum / n);
  sum = 0.0;
  int count = 0;
  for (const double l : lengths) {
    if (std::abs(l - median) > deviation) continue;
    sum += l;
    ++count;
  }
  return sum / count;
}

// Sixty rays stand for the cone up to about this share.
constexpr double kFewRays = 0.02;

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}
double smallest(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

}  // namespace

TEST_CASE("A slab is as thick as the cone's oblique rays make it", "[geometry][shape_diameter]") {
  // The lengths are t / c with c uniform in [½, 1]. The median is 4/3, the deviation √(2 − (2 ln
  // 2)²) = 0.2796, so that c in [0.6200, 0.9490] stays, where the mean of 1/c is ln(0.9490 /
  // 0.6200) / 0.3290 = 1.2940.
  CHECK(expected_thickness([](double theta, double) { return 1.0 / std::cos(theta); }) ==
        Approx(1.2940).epsilon(1e-3));
  for (const double thickness : {1e-6, 0.01}) {
    const MeshQuery slab(box({1.0, 2.0, thickness}));
    const ShapeDiameter measured = shape_diameter(slab);
    for (std::size_t face = 0; face < 12; ++face) {
      if (std::abs(face_normal(slab.mesh(), face)[2]) < 0.5) continue;
      CHECK(measured.num_hits[face] == 60);
      CHECK(measured.thickness[face] == Approx(1.2940 * thickness).epsilon(kFewRays));
    }
  }
}

TEST_CASE("A ball, a long cylinder and a thin torus are as thick as their chords",
          "[geometry][shape_diameter]") {
  // The chord of a ball is d cos θ, and the normal where it ends is turned by 180° − 2θ, so that
  // rays beyond 45° do not count. The result is the mean of cos θ, uniform in [cos 45°, 1], within
  // one deviation of its median.
  const double in_ball = expected_thickness(
      [](double theta, double) { return theta < pi / 4 ? std::cos(theta) : -1; });
  CHECK(in_ball == Approx(0.5 * (1.0 + std::sqrt(0.5))).epsilon(1e-3));
  const ShapeDiameter sphere = shape_diameter(MeshQuery(ball(0.5, 4)));
  CHECK(smallest(sphere.thickness) > in_ball * (1.0 - kFewRays));
  CHECK(largest(sphere.thickness) < in_ball * (1.0 + kFewRays));

  // A ray at (θ, φ) runs sin θ cos φ along the axis, with the length d cos θ / (1 − (sin θ cos
  // φ)²). Across, it is turned by the angle with the tangent tan θ sin φ, which may be 45° as in
  // the ball.
  const double in_cylinder = expected_thickness([](double theta, double phi) {
    if (std::abs(std::tan(theta) * std::sin(phi)) > 1.0) return -1.0;
    const double along = std::sin(theta) * std::cos(phi);
    return std::cos(theta) / (1.0 - along * along);
  });
  const MeshQuery bar(cylinder(0.5, 100.0, 96));
  const ShapeDiameter rod = shape_diameter(bar);
  int sides = 0;
  for (std::size_t face = 0; face < bar.mesh().faces.size(); ++face) {
    if (std::abs(face_normal(bar.mesh(), face)[2]) > 0.5) continue;
    CHECK(rod.thickness[face] == Approx(in_cylinder).epsilon(2 * kFewRays));
    ++sides;
  }
  CHECK(sides == 2 * 96);

  // The tube is bent to a circle 20 times as wide, and rays along it leave it a little earlier or
  // later.
  const ShapeDiameter tube = shape_diameter(MeshQuery(torus(10.0, 0.5, 192, 48)));
  CHECK(smallest(tube.thickness) > 0.93 * in_cylinder);
  CHECK(largest(tube.thickness) < 1.07 * in_cylinder);
}

TEST_CASE("One straight ray measures the thickness itself", "[geometry][shape_diameter]") {
  const MeshQuery brick(box({1, 2, 4}));
  const ShapeDiameter measured = shape_diameter(brick, {.num_rays = 1, .cone_angle_deg = 0.0});
  for (std::size_t face = 0; face < 12; ++face) {
    const Eigen::Vector3d normal = face_normal(brick.mesh(), face).cwiseAbs();
    CHECK(measured.thickness[face] == Approx(normal.dot(Eigen::Vector3d(1, 2, 4))));
  }
}

TEST_CASE("A straight ray along the edges of a grid meets the wall behind it",
          "[geometry][shape_diameter]") {
  // There are small faces over a wall of unit squares, each above an edge between two of them,
  // which is where boxes of the tree end.
  TriangleMesh mesh;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 17; ++i) mesh.vertices.emplace_back(i, j, 0.0);
  }
  for (std::int32_t j = 0; j < 2; ++j) {
    for (std::int32_t i = 0; i < 16; ++i) {
      const std::int32_t v = 17 * j + i;
      mesh.faces.push_back({v, v + 17, v + 1});  // The wall looks down.
      mesh.faces.push_back({v + 1, v + 17, v + 18});
    }
  }
  const std::size_t num_of_wall = mesh.faces.size();
  for (int i = 1; i < 16; ++i) {
    const auto v = static_cast<std::int32_t>(mesh.vertices.size());
    mesh.vertices.emplace_back(i - 0.25, 0.5, 1.0);
    mesh.vertices.emplace_back(i + 0.25, 0.5, 1.0);
    mesh.vertices.emplace_back(i, 0.75, 1.0);
    mesh.faces.push_back({v, v + 1, v + 2});
  }
  const ShapeDiameter measured =
      shape_diameter(MeshQuery(mesh), {.num_rays = 1, .cone_angle_deg = 0.0});
  for (std::size_t face = num_of_wall; face < mesh.faces.size(); ++face) {
    CHECK(measured.thickness[face] == Approx(1.0));
  }
}

TEST_CASE("Faces without an opposite wall are infinitely thick", "[geometry][shape_diameter]") {
  const double infinity = std::numeric_limits<double>::infinity();
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0},   {1, 0, 0},  {0, 1, 0}, {-9, -9, -1},
                   {9, -9, -1}, {0, 9, -1}, {2, 0, 0}};
  mesh.faces = {{0, 1, 2}};
  CHECK(shape_diameter(MeshQuery(mesh)).thickness[0] == infinity);
  // A wall below that looks the same way does not count; turned around it does.
  mesh.faces = {{0, 1, 2}, {3, 4, 5}};
  const ShapeDiameter same_way = shape_diameter(MeshQuery(mesh));
  CHECK(same_way.thickness == std::vector<double>{infinity, infinity});
  CHECK(same_way.num_hits == std::vector<std::int32_t>{0, 0});
  mesh.faces = {{0, 1, 2}, {3, 5, 4}, {0, 1, 6}};  // The last one is a segment.
  const ShapeDiameter facing = shape_diameter(MeshQuery(mesh));
  CHECK(facing.num_hits[0] == 60);
  CHECK(facing.thickness[0] < 2.0);
  CHECK(facing.thickness[2] == infinity);
}

TEST_CASE("Thickness is the same for any number of threads and scales with the body",
          "[geometry][shape_diameter]") {
  const TriangleMesh mesh = torus(0.1, 0.03, 40, 20);
  const ShapeDiameter one = shape_diameter(MeshQuery(mesh), {.num_threads = 1});
  for (const int threads : {0, 2, 5}) {
    const ShapeDiameter more = shape_diameter(MeshQuery(mesh), {.num_threads = threads});
    CHECK(more.thickness == one.thickness);
    CHECK(more.num_hits == one.num_hits);
  }
  const ShapeDiameter doubled = shape_diameter(MeshQuery(scaled(mesh, 2.0)));
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    REQUIRE(doubled.thickness[face] == Approx(2.0 * one.thickness[face]).epsilon(1e-9));
  }
}

TEST_CASE("Of some faces the thickness is that of all", "[geometry][shape_diameter]") {
  const MeshQuery mesh(torus(0.1, 0.03, 20, 10));
  const ShapeDiameter all = shape_diameter(mesh);
  const std::vector<std::int32_t> faces = {7, 399, 0, 7};
  const ShapeDiameter some = shape_diameter(mesh, faces);
  REQUIRE(some.thickness.size() == faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    CHECK(some.thickness[i] == all.thickness[faces[i]]);
    CHECK(some.num_hits[i] == all.num_hits[faces[i]]);
  }
  CHECK(shape_diameter(mesh, std::vector<std::int32_t>{}).thickness.empty());
  CHECK_THROWS_WITH(shape_diameter(mesh, std::vector<std::int32_t>{400}),
                    "shape_diameter: face 400 of 400");
}

TEST_CASE("Options of the shape diameter out of range are refused", "[geometry][shape_diameter]") {
  const MeshQuery cube(box({1, 1, 1}));
  CHECK_THROWS_WITH(shape_diameter(cube, {.num_rays = 0}),
                    "ShapeDiameterOptions: num_rays = 0, must be in [1, 10000]");
  CHECK_THROWS_AS(shape_diameter(cube, {.cone_angle_deg = 180.0}), InvalidInput);
  CHECK_THROWS_AS(shape_diameter(cube, {.cone_angle_deg = std::nan("")}), InvalidInput);
  CHECK_THROWS_AS(shape_diameter(cube, {.trim_deviations = 0.0}), InvalidInput);
  CHECK_THROWS_AS(shape_diameter(cube, {.num_threads = -1}), InvalidInput);
}

}  // namespace test_shape_diameter
