#include <limits>

#include "geometry/exact_clip.hpp"
#include "geometry/rational_clip.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "support/catch.hpp"

namespace test_exact_clip {

using namespace graspfit::base;
using namespace graspfit::geometry;
using namespace graspfit::testing;

namespace {

const Triangle kTriangle = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(3, 0, 0),
                            Eigen::Vector3d(0, 3, 0)};

template <typename Coordinate>
Triangle triangle_of(const Coordinate& coordinate) {
  Triangle triangle;
  for (Eigen::Vector3d& corner : triangle) {
    for (int axis = 0; axis < 3; ++axis) corner[axis] = coordinate();
  }
  return triangle;
}

// Compares cutting every voxel by itself with cutting slab by slab.
void check_against_single_voxels(const Triangle& triangle, const VoxelLattice& lattice) {
  TriangleMesh mesh;
  mesh.vertices.assign(triangle.begin(), triangle.end());
  mesh.faces = {{0, 1, 2}};
  const RationalPoint own =
      doubled_vector_area({exactly(triangle[0]), exactly(triangle[1]), exactly(triangle[2])});
  const auto expected = voxel_fractions(mesh, lattice);
  const auto pieces = exact_clip_by_voxels(triangle, lattice);
  REQUIRE(pieces.size() == expected.size());
  auto piece = pieces.begin();
  for (const auto& [name, fraction] : expected) {
    REQUIRE(piece->voxel == name.first);
    for (int axis = 0; axis < 3; ++axis) {
      REQUIRE(Rational(2) * Rational(piece->piece.vector_area[axis].to_string()) ==
              fraction * own[axis]);
    }
    ++piece;
  }
}

}  // namespace

TEST_CASE("Exact rationals are exact", "[geometry][exact_clip]") {
  const ExactRational third = ExactRational(1) / 3;
  CHECK(third.to_string() == "1/3");
  CHECK(third.numerator() == "1");
  CHECK(third.denominator() == "3");
  CHECK(third * 3 == 1);
  CHECK((third + third + third).to_string() == "1");
  CHECK(third.to_double() == Approx(1.0 / 3.0).epsilon(1e-15));
  // 0.1 is 3602879701896397 / 2^55, and ten of it are not one.
  CHECK(ExactRational(0.1).to_string() == "3602879701896397/36028797018963968");
  CHECK(ExactRational(0.1) * 10 > 1);
  CHECK(-ExactRational(0.1) < ExactRational());
  CHECK((ExactRational(-0.75)).sign() == -1);
  CHECK(ExactRational(-0.75).to_string() == "-3/4");
  CHECK((ExactRational(1e300) * 1e300 / 1e300).to_double() == 1e300);
  ExactRational copy = third;
  copy -= third;
  CHECK(copy.sign() == 0);
  CHECK(third.to_string() == "1/3");
  CHECK_THROWS_AS(ExactRational(std::numeric_limits<double>::infinity()), InvalidInput);
  CHECK_THROWS_AS(third / 0.0, InvalidInput);
}

TEST_CASE("A triangle cut to a pentagon has that pentagon's exact area and centroid",
          "[geometry][exact_clip]") {
  // The triangle (0,0), (3,0), (0,3) is cut at x ≤ 2 and y ≤ 2: corner triangles of area 1/2 with
  // centroids (7/3, 1/3) and (1/3, 7/3) go from 9/2 with (1, 1). What is left has 7/2, and (9/2 −
  // 4/3) / (7/2) = 19/21.
  const auto piece = exact_clip(kTriangle, {{{1, 0, 0}, 2.0}, {{0, 1, 0}, 2.0}});
  REQUIRE(piece);
  CHECK(piece->polygon.size() == 5);
  CHECK(piece->vector_area[0] == 0);
  CHECK(piece->vector_area[1] == 0);
  CHECK(piece->vector_area[2].to_string() == "7/2");
  CHECK(piece->centroid[0].to_string() == "19/21");
  CHECK(piece->centroid[1].to_string() == "19/21");
  CHECK(piece->centroid[2] == 0);
  CHECK(to_double(piece->centroid)[0] == Approx(19.0 / 21.0).epsilon(1e-15));
}

TEST_CASE("Exact clipping has the outcomes of clip at touches and in planes",
          "[geometry][exact_clip]") {
  for (const double z : {1.0, -1.0}) CHECK(exact_clip(kTriangle, {{{0, 0, z}, 0.0}}));
  CHECK_FALSE(exact_clip(kTriangle, {{{1, 1, 0}, 0.0}}));    // It is the corner (0, 0).
  CHECK_FALSE(exact_clip(kTriangle, {{{1, 0, 0}, 0.0}}));    // It is the edge along x = 0.
  CHECK_FALSE(exact_clip(kTriangle, {{{-1, 0, 0}, -3.0}}));  // It is the corner (3, 0).
  CHECK(exact_clip(kTriangle, {})->vector_area[2].to_string() == "9/2");
  CHECK_FALSE(exact_clip({kTriangle[0], kTriangle[1], kTriangle[1]}, {}));
  CHECK_THROWS_AS(exact_clip(kTriangle, {{{1, 0, 0}, std::nan("")}}), InvalidInput);
}

TEST_CASE("Exact pieces in voxels are those of every voxel for itself", "[geometry][exact_clip]") {
  Random random(31);
  const VoxelLattice lattice{Eigen::Vector3d::Zero(), 1.0, {3, 4, 5}};
  for (int round = 0; round < 120; ++round) {
    const bool is_smooth = round % 3 == 0;
    check_against_single_voxels(triangle_of([&] {
                                  return is_smooth ? random.uniform(0.0, 3.0)
                                                   : 0.5 * static_cast<double>(random.index(6));
                                }),
                                lattice);
  }
}

TEST_CASE("A triangle in the plane between two voxels belongs to the higher, exactly",
          "[geometry][exact_clip]") {
  const VoxelLattice lattice{Eigen::Vector3d::Zero(), 4.0, {2, 2, 2}};
  for (int axis = 0; axis < 3; ++axis) {
    Triangle triangle = kTriangle;
    for (Eigen::Vector3d& p : triangle) {
      p = axis == 0   ? Eigen::Vector3d(4, p[0], p[1])
          : axis == 1 ? Eigen::Vector3d(p[1], 4, p[0])
                      : Eigen::Vector3d(p[0], p[1], 4);
    }
    const auto pieces = exact_clip_by_voxels(triangle, lattice);
    REQUIRE(pieces.size() == 1);
    CHECK(pieces[0].voxel == lattice.index(Eigen::Vector3i::Unit(axis)));
    CHECK(pieces[0].piece.vector_area[axis].to_string() == "9/2");
  }
}

TEST_CASE("Exact clipping by voxels refuses what leaves the lattice", "[geometry][exact_clip]") {
  CHECK_THROWS_AS(exact_clip_by_voxels(kTriangle, VoxelLattice{}), InvalidInput);
  CHECK_THROWS_AS(exact_clip_by_voxels(kTriangle, {{0, 0, 0}, 1.0, {2, 3, 1}}), InvalidInput);
  CHECK_NOTHROW(exact_clip_by_voxels(kTriangle, {{0, 0, 0}, 1.0, {3, 3, 1}}));
  // In the last plane it belongs to a voxel that is not there.
  CHECK_THROWS_AS(exact_clip_by_voxels(kTriangle, {{0, 0, -1}, 1.0, {3, 3, 1}}), InvalidInput);
}

}  // namespace test_exact_clip
