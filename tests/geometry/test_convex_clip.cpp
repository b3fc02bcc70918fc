#include <cmath>
#include <limits>

#include "geometry/rational_clip.hpp"
#include "graspfit/geometry/convex_clip.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "support/catch.hpp"

using namespace graspfit::geometry;
using graspfit::testing::RationalPolygon;
using Triangle = std::array<Eigen::Vector3d, 3>;

namespace {

const Triangle kUnit = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0),
                        Eigen::Vector3d(0, 1, 0)};

template <typename Coordinate>
Eigen::Vector3d drawn(const Coordinate& coordinate) {
  const double x = coordinate();
  const double y = coordinate();
  const double z = coordinate();
  return {x, y, z};
}

double area_of(const std::optional<ClippedPiece>& piece) { return piece ? piece->area : 0.0; }

template <typename Coordinate>
void check_against_rationals(const Coordinate& coordinate, int rounds) {
  int nonempty = 0;
  for (int round = 0; round < rounds; ++round) {
    const Triangle triangle = {drawn(coordinate), drawn(coordinate), drawn(coordinate)};
    ConvexVolume volume;
    for (int i = 0; i < 5; ++i) volume.push_back({drawn(coordinate), coordinate()});
    RationalPolygon exact(triangle);
    if (!exact.has_area()) {
      CHECK_FALSE(clip(triangle, volume));
      continue;
    }
    for (const HalfSpace& h : volume) exact.clip(h.normal, h.offset);
    const auto piece = clip(triangle, volume);
    REQUIRE(piece.has_value() == exact.has_area());
    if (!piece) continue;
    ++nonempty;
    const double whole = 0.5 * (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).norm();
    REQUIRE(std::abs(piece->area - CGAL::to_double(exact.fraction()) * whole) <= 1e-12 * whole);
    // Every corner is within the stated bound of an exact corner.
    double edge = 0.0;
    double size = 0.0;
    for (int i = 0; i < 3; ++i) {
      edge = std::max(edge, (triangle[(i + 1) % 3] - triangle[i]).norm());
      size = std::max(size, triangle[i].cwiseAbs().maxCoeff());
    }
    for (const Eigen::Vector3d& corner : piece->polygon) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& p : exact.corners()) {
        double off = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
          off = std::max(off, std::abs(CGAL::to_double(p[axis] - CGAL::Gmpq(corner[axis]))));
        }
        nearest = std::min(nearest, off);
      }
      REQUIRE(nearest <= 0x1p-42 * edge + 0x1p-51 * size);
    }
  }
  CHECK(nonempty > rounds / 20);
}

}  // namespace

TEST_CASE("Clipping by random planes agrees with rational arithmetic", "[geometry][convex_clip]") {
  Random random(11);
  check_against_rationals([&] { return random.uniform(-1.0, 1.0); }, 400);
}

TEST_CASE("Clipping by planes through corners and edges agrees with rational arithmetic",
          "[geometry][convex_clip]") {
  // Small whole numbers: planes pass through corners, contain edges, coincide and are parallel.
  Random random(12);
  check_against_rationals([&] { return static_cast<double>(random.index(5)) - 2.0; }, 600);
}

TEST_CASE("Clipping by planes that are nearly the same agrees with rational arithmetic",
          "[geometry][convex_clip]") {
  Random random(13);
  check_against_rationals(
      [&] {
        const double x = static_cast<double>(random.index(3)) - 1.0;
        return random.index(2) == 0 ? x : x + 0x1p-52 * static_cast<double>(random.index(3));
      },
      400);
}

TEST_CASE("Clipping far from the origin agrees with rational arithmetic",
          "[geometry][convex_clip]") {
  Random random(14);
  for (int round = 0; round < 100; ++round) {
    const Eigen::Vector3d far = Eigen::Vector3d::Constant(1e6);
    const auto around = [&] { return random.uniform(-1.0, 1.0); };
    const Triangle triangle = {far + drawn(around), far + drawn(around), far + drawn(around)};
    const Eigen::Vector3d normal = drawn(around);
    const ConvexVolume volume = {{normal, normal.dot(far + 0.1 * drawn(around))}};
    RationalPolygon exact(triangle);
    exact.clip(volume[0].normal, volume[0].offset);
    const auto piece = clip(triangle, volume);
    REQUIRE(piece.has_value() == exact.has_area());
    if (!piece) continue;
    const double whole = 0.5 * (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).norm();
    REQUIRE(std::abs(piece->area - CGAL::to_double(exact.fraction()) * whole) <= 1e-12 * whole);
  }
}

TEST_CASE("The inside and the outside of a convex volume make up the whole surface",
          "[geometry][convex_clip]") {
  const TriangleMesh mesh = ball(1.0, 2);
  Random random(15);
  for (int round = 0; round < 20; ++round) {
    ConvexVolume volume;
    for (int i = 0; i < 6; ++i) {
      volume.push_back({drawn([&] { return random.uniform(-1.0, 1.0); }), random.uniform()});
    }
    double inside = 0.0;
    double outside = 0.0;
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
      const Triangle triangle = corners(mesh, face);
      inside += area_of(clip(triangle, volume));
      // Outside: within the first planes and beyond the next, for each next.
      ConvexVolume shell;
      for (const HalfSpace& h : volume) {
        shell.push_back({-h.normal, -h.offset});
        outside += area_of(clip(triangle, shell));
        shell.back() = h;
      }
    }
    CHECK(inside + outside == Approx(surface_area(mesh)).epsilon(1e-12));
  }
}

TEST_CASE("A triangle in a bounding plane counts as inside", "[geometry][convex_clip]") {
  for (const double z : {1.0, -1.0}) {
    const auto piece = clip(kUnit, {{{0, 0, z}, 0.0}});
    REQUIRE(piece);
    CHECK(piece->area == 0.5);
    CHECK(piece->polygon == std::vector<Eigen::Vector3d>(kUnit.begin(), kUnit.end()));
  }
}

TEST_CASE("Touching at a corner or along an edge is empty", "[geometry][convex_clip]") {
  CHECK_FALSE(clip(kUnit, {{{1, 1, 0}, 0.0}}));    // At the corner (0, 0).
  CHECK_FALSE(clip(kUnit, {{{1, 0, 0}, 0.0}}));    // Along x = 0.
  CHECK_FALSE(clip(kUnit, {{{-1, 0, 0}, -1.0}}));  // At the corner (1, 0).
}

TEST_CASE("A triangle cut to a square has that square's area and centroid",
          "[geometry][convex_clip]") {
  // (0,0), (2,0), (0,2) cut at x ≤ 1 and y ≤ 1 is the unit square; the cut edge passes through
  // (1,1).
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
  CHECK_FALSE(clip(kUnit, {{{0, 0, 0}, -1.0}}));           // 0 ≤ −1 holds nowhere,
  CHECK(area_of(clip(kUnit, {{{0, 0, 0}, 0.0}})) == 0.5);  // 0 ≤ 0 everywhere.
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
