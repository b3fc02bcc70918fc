#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

#include "graspfit/base/random.hpp"
#include "mesh/vertex_welding.hpp"
#include "support/catch.hpp"

namespace test_vertex_welding {

using namespace graspfit::base;
using graspfit::geometry::internal::weld_near;

namespace {

// The number that each vertex gets by comparing it with all vertices kept before it.
std::vector<std::int32_t> welded_by_all_pairs(const std::vector<Eigen::Vector3d>& vertices,
                                              double distance) {
  std::vector<Eigen::Vector3d> kept;
  std::vector<std::int32_t> target;
  for (const Eigen::Vector3d& vertex : vertices) {
    std::size_t first = 0;
    while (first < kept.size() && !((vertex - kept[first]).stableNorm() <= distance)) ++first;
    if (first == kept.size()) kept.push_back(vertex);
    target.push_back(static_cast<std::int32_t>(first));
  }
  return target;
}

}  // namespace

TEST_CASE("Vertices as near as the distance are welded, however large the mesh is against it",
          "[geometry][vertex_welding]") {
  // The middle two are exactly 2^-52 apart, but their rounded differences from the first are twice
  // as far apart.
  std::vector<Eigen::Vector3d> vertices = {{-0x1.88d356d81a817p-1, 0, 0},
                                           {0x1.3f98234822fcap-1, 0, 0},
                                           {0x1.3f98234822fccp-1, 0, 0},
                                           {0x1.a9e9562520296p-1, 0, 0}};
  CHECK(weld_near(vertices, 0x1p-52) == std::vector<std::int32_t>{0, 1, 1, 2});
  CHECK(vertices.size() == 3);
}

TEST_CASE("Vertices are welded as by comparing all pairs, at any ratio of extent to distance",
          "[geometry][vertex_welding]") {
  Random random(51);
  for (int exponent = 0; exponent <= 70; exponent += 2) {
    const double distance = std::ldexp(1.0, -exponent);
    std::vector<Eigen::Vector3d> vertices;
    for (int cluster = 0; cluster < 40; ++cluster) {
      const double x = random.uniform(-1.0, 1.0);
      const double y = random.uniform(-1.0, 1.0);
      for (int i = 0; i < 5; ++i) {
        const double aside = distance * random.uniform(-1.0, 1.0);
        const double ahead = distance * random.uniform(-1.0, 1.0);
        vertices.emplace_back(x + aside, y + ahead, 0.0);
      }
    }
    const std::vector<std::int32_t> expected = welded_by_all_pairs(vertices, distance);
    CAPTURE(exponent);
    CHECK(weld_near(vertices, distance) == expected);
  }
}

TEST_CASE("Vertices too far apart for their difference are welded where they are equal",
          "[geometry][vertex_welding]") {
  std::vector<Eigen::Vector3d> vertices = {
      {-1e308, 0, 0}, {1e308, 0, 0}, {-1e308, 0, 0}, {1e308, 1.0, 0}};
  CHECK(weld_near(vertices, 2.0) == std::vector<std::int32_t>{0, 1, 0, 2});
}

}  // namespace test_vertex_welding
