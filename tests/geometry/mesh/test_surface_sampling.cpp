#include <cmath>
#include <limits>

#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/surface_sampling.hpp"
#include "support/catch.hpp"

namespace test_surface_sampling {

using namespace graspfit::base;
using namespace graspfit::geometry;

namespace {

// Returns faces of areas 1 : 2 : 4 : 8, a face without area in between, and one that is far away.
TriangleMesh unequal_faces() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 2, 0}, {0, 4, 0}, {0, 8, 0}, {5, 0, 9}};
  mesh.faces = {{0, 1, 2}, {0, 1, 3}, {0, 0, 6}, {0, 1, 4}, {0, 1, 5}};
  return mesh;
}

void check_on_face(const TriangleMesh& mesh, const SurfaceSample& sample) {
  REQUIRE(sample.face >= 0);
  REQUIRE(sample.face < static_cast<std::int32_t>(mesh.faces.size()));
  REQUIRE(sample.barycentric.minCoeff() >= 0.0);
  REQUIRE(std::abs(sample.barycentric.sum() - 1.0) < 1e-15);
  const auto [a, b, c] = corners(mesh, sample.face);
  const Eigen::Vector3d& w = sample.barycentric;
  REQUIRE(sample.point == Eigen::Vector3d(w[0] * a + w[1] * b + w[2] * c));
  REQUIRE(sample.normal == face_normal(mesh, sample.face));
}

}  // namespace

TEST_CASE("Faces get samples in proportion to their area", "[geometry][surface_sampling]") {
  const TriangleMesh mesh = unequal_faces();
  constexpr std::size_t kCount = 15000;
  std::vector<double> seen(5, 0.0);
  for (const SurfaceSample& sample : sample_surface(mesh, {.count = kCount, .seed = 1})) {
    check_on_face(mesh, sample);
    seen[sample.face] += 1.0;
  }
  CHECK(seen[2] == 0.0);
  double chi_squared = 0.0;
  for (const auto& [face, share] : {std::pair{0, 1}, {1, 2}, {3, 4}, {4, 8}}) {
    const double expected = kCount * share / 15.0;
    chi_squared += (seen[face] - expected) * (seen[face] - expected) / expected;
  }
  CHECK(chi_squared < 16.3);  // This is the 99.9 % quantile for 3 degrees of freedom.
}

TEST_CASE("Within a face all places are equally likely", "[geometry][surface_sampling]") {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {3, 0, 0}, {1, 2, 1}};
  mesh.faces = {{0, 1, 2}};
  // Halving all edges gives four triangles of equal area: three at the corners, one in the middle.
  constexpr std::size_t kCount = 8000;
  std::array<double, 4> seen{};
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const SurfaceSample& sample : sample_surface(mesh, {.count = kCount, .seed = 2})) {
    int corner = 3;
    for (int i = 0; i < 3; ++i) {
      if (sample.barycentric[i] > 0.5) corner = i;
    }
    seen[corner] += 1.0;
    mean += sample.barycentric / kCount;
  }
  double chi_squared = 0.0;
  for (const double count : seen) {
    chi_squared += (count - kCount / 4.0) * (count - kCount / 4.0) / (kCount / 4.0);
  }
  CHECK(chi_squared < 16.3);  // This is the same quantile.
  // Each weight has variance 1/18; the bound is five standard errors of the mean.
  CHECK((mean.array() - 1.0 / 3.0).abs().maxCoeff() < 5.0 * std::sqrt(1.0 / 18.0 / kCount));
}

TEST_CASE("Fewer samples are the beginning of more; seeds differ", "[geometry][surface_sampling]") {
  const TriangleMesh mesh = ball(1.0, 2);
  const auto many = sample_surface(mesh, {.count = 100, .seed = 3});
  const auto few = sample_surface(mesh, {.count = 40, .seed = 3});
  CHECK(std::equal(few.begin(), few.end(), many.begin()));
  CHECK_FALSE(sample_surface(mesh, {.count = 40, .seed = 4}) == few);
  CHECK(sample_surface(mesh, {.count = 0}).empty());
}

TEST_CASE("Surfaces without area and bad sampling options are refused",
          "[geometry][surface_sampling]") {
  TriangleMesh flat;
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  flat.faces = {{0, 1, 2}};
  CHECK_THROWS_AS(sample_surface(flat), DegenerateGeometry);
  CHECK_THROWS_AS(sample_surface(TriangleMesh{}), DegenerateGeometry);
  const TriangleMesh mesh = box({1, 1, 1});
  CHECK_THROWS_WITH(sample_surface(mesh, {.count = 10'000'001}),
                    "SurfaceSamplingOptions: count = 10000001, must be at most 10000000");
}

}  // namespace test_surface_sampling
