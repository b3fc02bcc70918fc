#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/convex_hull.hpp"
#include "support/catch.hpp"

namespace test_convex_hull {

using namespace graspfit::base;
using namespace graspfit::geometry;
using Points = std::vector<Eigen::Vector3d>;
using Indices = std::vector<std::size_t>;

TEST_CASE("The hull of a cube has its corners, volume and center", "[geometry][convex_hull]") {
  Points points;
  for (int i = 0; i < 8; ++i) points.emplace_back(i & 1 ? 2 : 0, i & 2 ? 2 : 0, i & 4 ? 2 : 0);
  // These are not extreme: the center, and middles of faces and edges.
  points.insert(points.end(), {{1, 1, 1}, {1, 1, 0}, {1, 0, 0}, {2, 1, 1}});
  const ConvexHull3 hull = convex_hull(points);
  CHECK(hull.rank == 3);
  CHECK(hull.vertices == Indices{0, 1, 2, 3, 4, 5, 6, 7});
  CHECK(hull.facets.size() == 12);
  CHECK(hull.measure == Approx(8.0));
  CHECK((hull.centroid - Eigen::Vector3d(1, 1, 1)).norm() < 1e-14);
  for (const HullFacet& facet : hull.facets) {
    const Eigen::Vector3d normal =
        (points[facet[1]] - points[facet[0]]).cross(points[facet[2]] - points[facet[0]]);
    CHECK(normal.dot(points[facet[0]] - Eigen::Vector3d(1, 1, 1)) > 0.0);
  }
}

TEST_CASE("The hull of a simplex is the simplex", "[geometry][convex_hull]") {
  const ConvexHull3 hull = convex_hull(Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  CHECK(hull.rank == 3);
  CHECK(hull.facets.size() == 4);
  CHECK(hull.measure == Approx(1.0 / 6.0));
  CHECK((hull.centroid - Eigen::Vector3d::Constant(0.25)).norm() < 1e-15);
}

TEST_CASE("The cross-polytope has eight facets and volume 4/3", "[geometry][convex_hull]") {
  const ConvexHull3 hull = convex_hull(
      Points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {0, 0, 0}});
  CHECK(hull.vertices == Indices{0, 1, 2, 3, 4, 5});
  CHECK(hull.facets.size() == 8);
  CHECK(hull.measure == Approx(4.0 / 3.0));
}

TEST_CASE("Points of lower dimension have the hull of their rank", "[geometry][convex_hull]") {
  CHECK(convex_hull(Points{}).rank == -1);

  const ConvexHull3 point = convex_hull(Points{{1, 2, 3}, {1, 2, 3}});
  CHECK(point.rank == 0);
  CHECK(point.vertices == Indices{0});
  CHECK(point.centroid == Eigen::Vector3d(1, 2, 3));
  CHECK(point.measure == 0.0);

  const ConvexHull3 segment = convex_hull(Points{{1, 1, 1}, {0, 0, 0}, {3, 3, 3}, {2, 2, 2}});
  CHECK(segment.rank == 1);
  CHECK(segment.vertices == Indices{1, 2});
  CHECK(segment.measure == Approx(3.0 * std::sqrt(3.0)));
  CHECK((segment.centroid - Eigen::Vector3d::Constant(1.5)).norm() < 1e-14);

  // The points are a rectangle in the plane x + y + z = 0, with its center and a point on an edge.
  const ConvexHull3 polygon = convex_hull(
      Points{{1, -1, 0}, {0, 0, 0}, {1, 0, -1}, {-1, 1, 0}, {-1, 0, 1}, {1, -0.5, -0.5}});
  CHECK(polygon.rank == 2);
  CHECK(polygon.facets.size() == 1);
  CHECK(std::set<std::size_t>(polygon.vertices.begin(), polygon.vertices.end()) ==
        std::set<std::size_t>{0, 2, 3, 4});
  // The sides are (0, 1, −1) of length sqrt 2 and (2, −1, −1) of length sqrt 6, at right angles.
  CHECK(polygon.measure == Approx(std::sqrt(12.0)));
  CHECK(polygon.centroid.norm() < 1e-14);
}

TEST_CASE("An ulp off the plane is a solid, unless a threshold says flat",
          "[geometry][convex_hull]") {
  Points points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0x1p-50}};
  CHECK(convex_hull(points).rank == 3);
  CHECK(convex_hull(points, {.planar_rel = 1e-6}).rank == 2);
  CHECK(convex_hull(points, {.planar_rel = 1e-6}).measure == Approx(1.0));
  points = {{0, 0, 0}, {1, 0x1p-50, 0}, {2, 0, 0}};
  CHECK(convex_hull(points).rank == 2);
  CHECK(convex_hull(points, {.collinear_rel = 1e-3}).rank == 1);
  points = {{0, 0, 0}, {0, 0, 1e-4}, {1, 0, 0}};
  CHECK(convex_hull(points).rank == 2);
}

TEST_CASE("A nearly flat polygon is measured in its plane, whatever the order of its points",
          "[geometry][convex_hull]") {
  // The corners of a unit square are by turns 2 cm above and below the plane that fits them best.
  Points points = {{0, 0, 0.02}, {1, 0, -0.02}, {1, 1, 0.02}, {0, 1, -0.02}};
  for (std::size_t first = 0; first < points.size(); ++first) {
    const ConvexHull3 square = convex_hull(points, {.planar_rel = 0.1});
    CHECK(square.rank == 2);
    CHECK(square.measure == Approx(1.0));
    CHECK((square.centroid - Eigen::Vector3d(0.5, 0.5, 0.0)).norm() < 1e-14);
    std::rotate(points.begin(), points.begin() + 1, points.end());
  }
}

TEST_CASE("A flattened needle is a segment, and a hull without measure has a centroid",
          "[geometry][convex_hull]") {
  // The thickness along both short axes is far below an ulp of the long one, so that the projected
  // points are collinear.
  const ConvexHull3 needle = convex_hull(
      Points{{1, 1, 1}, {2, 2, 2}, {3, 3, 3 + 0x1p-51}, {2, 2 + 0x1p-51, 2}}, {.planar_rel = 1e-6});
  CHECK(needle.rank >= 1);
  CHECK(needle.centroid.allFinite());
  CHECK((needle.centroid - Eigen::Vector3d::Constant(2.0)).norm() < 1.0);
  // The area, 5e-401 m², is less than a double can hold: its rounded form is the least that there
  // is.
  const ConvexHull3 speck = convex_hull(Points{{0, 0, 0}, {1e-200, 0, 0}, {0, 1e-201, 0}});
  CHECK(speck.rank == 2);
  CHECK(speck.measure >= 0.0);
  CHECK(speck.centroid.allFinite());
  const ConvexHull3 grain =
      convex_hull(Points{{0, 0, 0}, {1e-200, 0, 0}, {0, 1e-200, 0}, {0, 0, 1e-200}});
  CHECK(grain.rank == 3);
  CHECK(grain.measure == 0.0);
  CHECK(grain.centroid.x() == Approx(0.25e-200));
}

TEST_CASE("Every point is inside all facets of its hull, and facets close up",
          "[geometry][convex_hull]") {
  Random random(51);
  for (const int count : {4, 10, 200}) {
    Points points;
    for (int i = 0; i < count; ++i) {
      const double x = random.uniform(-1, 1);
      const double y = random.uniform(-1, 1);
      points.emplace_back(x, y, random.uniform(-1, 1));
    }
    const ConvexHull3 hull = convex_hull(points);
    REQUIRE(hull.rank == 3);
    // By Euler a triangulated sphere has 2 V − 4 faces.
    CHECK(hull.facets.size() == 2 * hull.vertices.size() - 4);
    Eigen::Vector3d total = Eigen::Vector3d::Zero();
    for (const HullFacet& facet : hull.facets) {
      const Eigen::Vector3d normal =
          (points[facet[1]] - points[facet[0]]).cross(points[facet[2]] - points[facet[0]]);
      total += normal;
      for (const auto& point : points) CHECK(normal.dot(point - points[facet[0]]) <= 1e-14);
    }
    CHECK(total.norm() < 1e-13);
  }
}

TEST_CASE("Hulls of points that are not finite or with negative thresholds are refused",
          "[geometry][convex_hull]") {
  CHECK_THROWS_AS(convex_hull(Points{{0, 0, std::nan("")}}), InvalidInput);
  CHECK_THROWS_AS(convex_hull(Points{{0, 0, 0}}, {.planar_rel = -1.0}), InvalidInput);
}

}  // namespace test_convex_hull
