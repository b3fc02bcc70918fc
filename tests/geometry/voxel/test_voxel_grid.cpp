#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "geometry/rational_clip.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "graspfit/geometry/voxel_grid.hpp"
#include "support/catch.hpp"

namespace test_voxel_grid {

using namespace graspfit::base;
using namespace graspfit::geometry;

namespace {

VoxelGrid voxels_of(const TriangleMesh& mesh, const VoxelLattice& lattice) {
  return voxelize(MeshQuery(mesh), lattice, surface_patches(mesh, lattice));
}

// Returns the sum of the solid angles of all faces seen from a point: 4 pi inside, 0 outside [Van
// Oosterom & Strackee 1983].
double solid_angle(const TriangleMesh& mesh, const Eigen::Vector3d& point) {
  double sum = 0.0;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    auto [a, b, c] = corners(mesh, face);
    a -= point;
    b -= point;
    c -= point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2.0 * std::atan2(a.dot(b.cross(c)),
                            la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum;
}

// Computes classes from the definition: a voxel is partial if and only if rational clipping leaves
// a face some area in it; else it is full if and only if the solid angle at its center says so.
VoxelGrid brute_force(const TriangleMesh& mesh, const VoxelLattice& lattice) {
  std::set<std::int64_t> partial;
  for (const auto& [name, fraction] : graspfit::testing::voxel_fractions(mesh, lattice)) {
    partial.insert(name.first);
  }
  VoxelGrid grid{lattice, {}};
  for (std::int64_t index = 0; index < lattice.num_voxels(); ++index) {
    const double angle = solid_angle(mesh, lattice.center(lattice.voxel(index)));
    grid.classes.push_back(partial.count(index) != 0        ? VoxelClass::Partial
                           : angle > 2.0 * std::numbers::pi ? VoxelClass::Full
                                                            : VoxelClass::Empty);
  }
  return grid;
}

}  // namespace

TEST_CASE("A box aligned with the lattice has the counts of the tie rule",
          "[geometry][voxel_grid]") {
  // Box of 8 x 6 x 4 voxels, its faces in voxel planes, its low corner at (2, 2, 2). A low face in
  // plane 2 belongs to layer 2 of its axis, a high face in plane 2 + n to layer 2 + n, outside the
  // box. In the other two axes each face reaches over its n1 x n2 voxels. So:
  //   low faces   the union of three n1 x n2 layers with a common corner:
  //               n1 n2 n3 − (n1 − 1)(n2 − 1)(n3 − 1) = 192 − 7·5·3 = 87
  //   high faces  8·6 + 6·4 + 8·4 = 104, none in common
  //   full        7·5·3 = 105
  TriangleMesh mesh = box({8.0, 6.0, 4.0});
  for (auto& vertex : mesh.vertices) vertex += Eigen::Vector3d(6, 5, 4);
  const VoxelLattice lattice{Eigen::Vector3d::Zero(), 1.0, {13, 11, 9}};
  const VoxelGrid grid = voxels_of(mesh, lattice);
  CHECK(grid.count(VoxelClass::Partial) == 87 + 104);
  CHECK(grid.count(VoxelClass::Full) == 105);
  CHECK(grid.count(VoxelClass::Empty) == 13 * 11 * 9 - 87 - 104 - 105);
  CHECK(grid.classes == brute_force(mesh, lattice).classes);
}

TEST_CASE("A box that lies across the lattice has the counts of its cross section",
          "[geometry][voxel_grid]") {
  // The box is half a voxel off, so that faces run through the middle of voxels. It then reaches
  // over 9 x 7 x 5 voxels, of which the inner 7 x 5 x 3 are full.
  TriangleMesh mesh = box({8.0, 6.0, 4.0});
  for (auto& vertex : mesh.vertices) vertex += Eigen::Vector3d(6.5, 5.5, 4.5);
  const VoxelGrid grid = voxels_of(mesh, {Eigen::Vector3d::Zero(), 1.0, {13, 11, 9}});
  CHECK(grid.count(VoxelClass::Full) == 7 * 5 * 3);
  CHECK(grid.count(VoxelClass::Partial) == 9 * 7 * 5 - 7 * 5 * 3);
}

TEST_CASE("Voxel classes are those of brute force", "[geometry][voxel_grid]") {
  // There are lattices of unequal counts, one per body, in a general position and with vertices in
  // planes.
  const RigidTransform X(Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, -2, 3).normalized()));
  TriangleMesh whole = box({4.0, 2.0, 3.0});
  for (auto& vertex : whole.vertices) vertex += Eigen::Vector3d(3.0, 3.0, 2.5);
  const VoxelLattice by_planes{Eigen::Vector3d::Zero(), 0.5, {11, 9, 10}};
  std::vector<std::pair<TriangleMesh, VoxelLattice>> cases = {{whole, by_planes}};
  for (const TriangleMesh& mesh :
       {ball(1.0, 1), torus(1.0, 0.4, 16, 8), capsule(0.3, 1.0, 8),
        transformed(box({1.0, 0.7, 0.3}), X), transformed(capsule(0.2, 1.0, 8), X)}) {
    cases.emplace_back(mesh, lattice_around(bounding_box(mesh), {.resolution = 9}));
  }
  for (const auto& [mesh, lattice] : cases) {
    const VoxelGrid grid = voxels_of(mesh, lattice);
    CHECK(grid.classes == brute_force(mesh, lattice).classes);
    CHECK(grid.count(VoxelClass::Full) > 0);
  }
}

TEST_CASE("A ball of 30 voxels has as many partial voxels as its surface predicts",
          "[geometry][voxel_grid]") {
  // A plane meets one voxel more per unit of area projected on each axis. Averaged over the sphere
  // that is 1.5 a voxel face: 1.5 · pi · 30² = 4241 where the sphere is locally flat; its curvature
  // takes some off (an independent count is 4056 for one position). Full and partial voxels bracket
  // the volume.
  const TriangleMesh mesh = ball(15.0, 5);
  const VoxelGrid grid = voxels_of(mesh, lattice_around(bounding_box(mesh), {}));
  const auto partial = static_cast<double>(grid.count(VoxelClass::Partial));
  const auto full = static_cast<double>(grid.count(VoxelClass::Full));
  CHECK(partial > 0.93 * 4241);
  CHECK(partial < 1.02 * 4241);
  const double volume = 4.0 / 3.0 * std::numbers::pi * 15.0 * 15.0 * 15.0;
  CHECK(full < volume);
  CHECK(full + partial > volume);
}

TEST_CASE("Every partial voxel has a patch and every other is wholly on one side",
          "[geometry][voxel_grid]") {
  const TriangleMesh mesh = torus(0.05, 0.02, 40, 20);
  const MeshQuery query(mesh);
  const VoxelLattice lattice = lattice_around(bounding_box(mesh), {.resolution = 20});
  const auto patches = surface_patches(mesh, lattice);
  const VoxelGrid grid = voxelize(query, lattice, patches);
  std::set<std::int64_t> with_patch;
  for (const SurfacePatch& patch : patches) with_patch.insert(patch.voxel);
  for (std::int64_t index = 0; index < lattice.num_voxels(); ++index) {
    const bool is_partial = grid.classes[index] == VoxelClass::Partial;
    CHECK(is_partial == (with_patch.count(index) == 1));
    if (is_partial) continue;
    const bool is_inside =
        query.containment(lattice.center(lattice.voxel(index))) == Containment::Inside;
    CHECK((grid.classes[index] == VoxelClass::Full) == is_inside);
  }
}

TEST_CASE("A cavity is empty, overlapping parts are united", "[geometry][voxel_grid]") {
  TriangleMesh hollow = concatenated({box({9, 9, 9}), box({5, 5, 5})});
  for (std::size_t face = 12; face < 24; ++face)
    std::swap(hollow.faces[face][1], hollow.faces[face][2]);
  const VoxelLattice lattice{Eigen::Vector3d::Constant(-5.5), 1.0, Eigen::Vector3i::Constant(11)};
  const VoxelGrid with_cavity = voxels_of(hollow, lattice);
  CHECK(with_cavity.at({5, 5, 5}) == VoxelClass::Empty);
  CHECK(with_cavity.at({2, 2, 2}) == VoxelClass::Full);

  const TriangleMesh both = concatenated({box({9, 3, 3}), box({3, 9, 3})});
  const VoxelGrid united = voxels_of(both, lattice);
  CHECK(united.at({2, 5, 5}) == VoxelClass::Full);
  CHECK(united.at({5, 5, 5}) == VoxelClass::Full);
  CHECK(united.at({2, 2, 5}) == VoxelClass::Empty);
}

TEST_CASE("A lattice has the asked voxels along the longest extent and the box in its middle",
          "[geometry][voxel_grid]") {
  const Eigen::AlignedBox3d object(Eigen::Vector3d(-0.1, 0.0, 0.3),
                                   Eigen::Vector3d(0.2, 0.2, 0.45));
  for (const double margin : {0.0, 0.004, 0.01, 0.123}) {
    const VoxelLattice lattice = lattice_around(object, {.resolution = 30, .margin = margin});
    CHECK(lattice.voxel_size == Approx(0.01));
    // 0.3, 0.2 and 0.15 are whole numbers of voxels; the margin is rounded up and at least one.
    const int side = std::max(1, static_cast<int>(std::ceil(margin / 0.01 * (1 - 1e-12))));
    CHECK(lattice.counts == Eigen::Vector3i(30 + 2 * side, 20 + 2 * side, 15 + 2 * side));
    const Eigen::Vector3d top = lattice.origin + lattice.voxel_size * lattice.counts.cast<double>();
    CHECK((0.5 * (lattice.origin + top) - object.center()).norm() < 1e-15);
    CHECK((lattice.origin.array() <= object.min().array() - margin).all());
  }
}

TEST_CASE("Voxel, index and position belong together", "[geometry][voxel_grid]") {
  const VoxelLattice lattice{{0.1, -0.2, 0.3}, 0.01, {5, 7, 3}};
  CHECK(lattice.num_voxels() == 105);
  for (std::int64_t index = 0; index < lattice.num_voxels(); ++index) {
    const Eigen::Vector3i voxel = lattice.voxel(index);
    CHECK(lattice.contains(voxel));
    CHECK(lattice.index(voxel) == index);
    CHECK(lattice.voxel_at(lattice.center(voxel)) == voxel);
  }
  CHECK(lattice.index({1, 0, 0}) == 1);
  CHECK_FALSE(lattice.contains({5, 0, 0}));
  CHECK_FALSE(lattice.contains({0, -1, 0}));
}

TEST_CASE("A lattice refuses what it cannot hold", "[geometry][voxel_grid]") {
  const Eigen::AlignedBox3d unit(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());
  CHECK_THROWS_AS(lattice_around(Eigen::AlignedBox3d(), {}), DegenerateGeometry);
  CHECK_THROWS_AS(
      lattice_around({Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}, LatticeOptions{}),
      DegenerateGeometry);
  CHECK_THROWS_WITH(lattice_around(unit, {.resolution = 3}),
                    "resolution is 3, must be in [4, 512]");
  CHECK_THROWS_AS(lattice_around(unit, {.resolution = 513}), InvalidInput);
  CHECK_THROWS_WITH(lattice_around(unit, {.margin = -1.0}), "margin is -1 m, must be 0 or more");
  CHECK_THROWS_WITH(lattice_around(unit, {.resolution = 512, .margin = 2.0}),
                    graspfit::testing::Contains("too many"));
  // Flat boxes have one layer and their margin.
  const Eigen::AlignedBox3d flat(Eigen::Vector3d::Zero(), Eigen::Vector3d(1, 1, 0));
  CHECK(lattice_around(flat, {.resolution = 4}).counts == Eigen::Vector3i(6, 6, 3));
}

}  // namespace test_voxel_grid
