#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/rational_clip.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/convex_clip.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

namespace test_convex_clip {

using namespace graspfit::base;
using namespace graspfit::geometry;
using Triangle = std::array<Eigen::Vector3d, 3>;

namespace {

const Triangle kUnit = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0),
                        Eigen::Vector3d(0, 1, 0)};

double area_of(const std::optional<ClippedPiece>& piece) { return piece ? piece->area : 0.0; }

}  // namespace

TEST_CASE("A triangle in a bounding plane counts as inside", "[geometry][convex_clip]") {
  for (const double z : {1.0, -1.0}) {
    const auto piece = clip(kUnit, {{{0, 0, z}, 0.0}});
    REQUIRE(piece);
    CHECK(piece->area == 0.5);
    CHECK(piece->polygon == std::vector<Eigen::Vector3d>(kUnit.begin(), kUnit.end()));
  }
}

TEST_CASE("Touching at a corner or along an edge is empty", "[geometry][convex_clip]") {
  CHECK_FALSE(clip(kUnit, {{{1, 1, 0}, 0.0}}));    // It is the corner (0, 0).
  CHECK_FALSE(clip(kUnit, {{{1, 0, 0}, 0.0}}));    // It is the edge along x = 0.
  CHECK_FALSE(clip(kUnit, {{{-1, 0, 0}, -1.0}}));  // It is the corner (1, 0).
}

TEST_CASE("A triangle cut to a square has that square's area and centroid",
          "[geometry][convex_clip]") {
  // The triangle (0,0), (2,0), (0,2) cut at x ≤ 1 and y ≤ 1 is the unit square; the cut edge passes
  // through (1,1).
  const Triangle triangle = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(2, 0, 0),
                             Eigen::Vector3d(0, 2, 0)};
  const auto piece = clip(triangle, {{{1, 0, 0}, 1.0}, {{0, 1, 0}, 1.0}});
  REQUIRE(piece);
  CHECK(piece->area == Approx(1.0));
  CHECK((piece->centroid - Eigen::Vector3d(0.5, 0.5, 0)).norm() < 1e-15);
  CHECK(piece->polygon.size() == 4);
}

TEST_CASE("Without planes the whole triangle is left, between contradicting ones nothing",
          "[geometry][convex_clip]") {
  CHECK(area_of(clip(kUnit, {})) == 0.5);
  CHECK_FALSE(clip(kUnit, {{{1, 0, 0}, 0.25}, {{-1, 0, 0}, -0.75}}));
  CHECK_FALSE(clip(kUnit, {{{0, 0, 0}, -1.0}}));           // 0 ≤ −1 holds nowhere.
  CHECK(area_of(clip(kUnit, {{{0, 0, 0}, 0.0}})) == 0.5);  // 0 ≤ 0 holds everywhere.
}

TEST_CASE("Degenerate triangles have no piece", "[geometry][convex_clip]") {
  const Eigen::Vector3d p(0.1, 0.2, 0.3);
  CHECK_FALSE(clip(Triangle{p, p, p}, {}));
  CHECK_FALSE(clip(Triangle{p, 2 * p, 4 * p}, {}));
}

TEST_CASE("The length of a plane's normal does not matter", "[geometry][convex_clip]") {
  const auto unit = clip(kUnit, {{{1, 0, 0}, 0.5}});
  for (const double factor : {0x1p-300, 3.0, 0x1p300}) {
    const auto scaled = clip(kUnit, {{{factor, 0, 0}, 0.5 * factor}});
    REQUIRE(scaled);
    CHECK(scaled->area == Approx(unit->area));
  }
}

TEST_CASE("Corners keep their bound where the terms of a plane are all but zero",
          "[geometry][convex_clip]") {
  // A multiple of y ≤ 1/2 whose values at the corners have few bits left, beside a plane whose
  // values are so large that the products are of ordinary size.
  const Triangle triangle = {Eigen::Vector3d(0, 0.1, 0), {0x1p200, 0.37, 0}, {0x1p199, 0.83, 0}};
  const ConvexVolume volume = {{{1, 0, 0}, 0x1p199 + 0x1p197}, {{0, 0x1p-1060, 0}, 0x1p-1061}};
  const auto piece = clip(triangle, volume);
  REQUIRE(piece);
  graspfit::testing::RationalPolygon exact(triangle);
  for (const HalfSpace& half_space : volume) exact.clip(half_space.normal, half_space.offset);
  REQUIRE(piece->polygon.size() == exact.corners().size());
  const double bound = graspfit::testing::corner_bound(triangle);
  for (const Eigen::Vector3d& corner : piece->polygon) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const graspfit::testing::RationalPoint& place : exact.corners()) {
      nearest = std::min(nearest, graspfit::testing::distance(corner, place));
    }
    CHECK(nearest <= bound);
  }
  // The triangle has 1.19 * 2^198 square meters.
  CHECK(piece->area == Approx(0x1p198 * 1.19 * CGAL::to_double(exact.fraction())).epsilon(1e-11));
}

TEST_CASE("Pieces of mesh faces come in the order asked for and name their face",
          "[geometry][convex_clip]") {
  const TriangleMesh cube = box({2.0, 2.0, 2.0});
  const std::vector<std::int32_t> faces = {11, 0, 5, 2};
  const auto pieces = clip(cube, faces, {{{0, 0, 1}, 0.0}});  // Faces 2 and 3 are the top.
  REQUIRE(pieces.size() == 3);
  CHECK(pieces[0].face == 11);
  CHECK(pieces[1].face == 0);
  CHECK(pieces[2].face == 5);
}

TEST_CASE("A half-space that is not finite is refused", "[geometry][convex_clip]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(clip(kUnit, {{{1, 0, 0}, nan}}), InvalidInput);
  CHECK_THROWS_WITH(clip(kUnit, {{{1, 0, 0}, 1.0}, {{nan, 0, 0}, 0.0}}),
                    "clip: half-space 1 is not finite");
}

}  // namespace test_convex_clip
