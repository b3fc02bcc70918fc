#include <cmath>
#include <limits>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/distance_map.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "support/catch.hpp"
#include "voxel/bounded_distance.hpp"

namespace test_distance_map {

using namespace graspfit::base;
using namespace graspfit::geometry;

namespace {

VoxelGrid grid_of(const Eigen::Vector3i& counts, VoxelClass everywhere) {
  VoxelGrid grid{{Eigen::Vector3d::Zero(), 1.0, counts}, {}};
  grid.classes.assign(static_cast<std::size_t>(grid.lattice.num_voxels()), everywhere);
  return grid;
}

std::vector<float> brute_force(const VoxelGrid& grid) {
  std::vector<float> values;
  for (std::int64_t i = 0; i < grid.lattice.num_voxels(); ++i) {
    int best = std::numeric_limits<int>::max();
    for (std::int64_t j = 0; j < grid.lattice.num_voxels(); ++j) {
      if (grid.classes[j] != VoxelClass::Partial) continue;
      best = std::min(best, (grid.lattice.voxel(i) - grid.lattice.voxel(j)).squaredNorm());
    }
    const float distance = best == std::numeric_limits<int>::max()
                               ? std::numeric_limits<float>::infinity()
                               : static_cast<float>(std::sqrt(static_cast<double>(best)));
    values.push_back(grid.classes[i] == VoxelClass::Full ? -distance : distance);
  }
  return values;
}

}  // namespace

TEST_CASE("The distance map is that of brute force on random grids", "[geometry][distance_map]") {
  Random random(21);
  for (int round = 0; round < 60; ++round) {
    const Eigen::Vector3i counts(1 + static_cast<int>(random.index(20)),
                                 1 + static_cast<int>(random.index(9)),
                                 1 + static_cast<int>(random.index(9)));
    VoxelGrid grid = grid_of(counts, VoxelClass::Empty);
    const double density = random.uniform() < 0.5 ? 0.01 : 0.3;
    for (VoxelClass& c : grid.classes) {
      if (random.uniform() < density) {
        c = VoxelClass::Partial;
      } else if (random.uniform() < 0.5) {
        c = VoxelClass::Full;
      }
    }
    REQUIRE(signed_distance_map(grid).values == brute_force(grid));
  }
}

TEST_CASE("Bounded distances are those of the distance map as far as their bound",
          "[geometry][distance_map]") {
  Random random(5);
  for (int round = 0; round < 60; ++round) {
    const Eigen::Vector3i counts(1 + static_cast<int>(random.index(40)),
                                 1 + static_cast<int>(random.index(12)),
                                 1 + static_cast<int>(random.index(12)));
    VoxelGrid grid = grid_of(counts, VoxelClass::Empty);
    const double density = random.uniform() < 0.5 ? 0.003 : 0.1;
    std::vector<char> is_source(grid.classes.size(), 0);
    for (std::size_t i = 0; i < is_source.size(); ++i) {
      if (random.uniform() >= density) continue;
      grid.classes[i] = VoxelClass::Partial;
      is_source[i] = 1;
    }
    const std::vector<float> whole = signed_distance_map(grid).values;
    for (const double bound : {0.0, 1.0, 2.5, random.uniform(0.0, 12.0), 1e9}) {
      CAPTURE(round, bound);
      const internal::BoundedDistance bounded(grid.lattice, is_source, bound);
      std::vector<float> values;
      std::vector<float> expected;
      for (std::int64_t i = 0; i < grid.lattice.num_voxels(); ++i) {
        values.push_back(bounded.at(i));
        expected.push_back(whole[i] <= bound ? whole[i] : std::numeric_limits<float>::infinity());
      }
      CHECK(values == expected);
    }
  }
}

TEST_CASE("Without a partial voxel all distances are infinite", "[geometry][distance_map]") {
  for (const float value : signed_distance_map(grid_of({3, 4, 5}, VoxelClass::Empty)).values) {
    CHECK(value == std::numeric_limits<float>::infinity());
  }
  CHECK(signed_distance_map(grid_of({1, 1, 1}, VoxelClass::Partial)).values ==
        std::vector<float>{0.0F});
}

TEST_CASE("The distance map of a solid is that of brute force, its signs those of containment",
          "[geometry][distance_map]") {
  const RigidTransform X(Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, -2, 3).normalized()));
  for (const TriangleMesh& mesh :
       {ball(1.0, 2), torus(1.0, 0.4, 16, 8), transformed(box({1.0, 0.6, 0.4}), X)}) {
    const MeshQuery query(mesh);
    const VoxelLattice lattice =
        lattice_around(bounding_box(mesh), {.resolution = 12, .margin = 0.3});
    const VoxelGrid grid = voxelize(query, lattice, surface_patches(mesh, lattice));
    const SignedDistanceMap map = signed_distance_map(grid);
    REQUIRE(map.values == brute_force(grid));
    CHECK(grid.count(VoxelClass::Full) > 0);
    for (std::int64_t index = 0; index < lattice.num_voxels(); ++index) {
      if (map.values[index] == 0.0F) continue;
      const bool is_inside =
          query.containment(lattice.center(lattice.voxel(index))) == Containment::Inside;
      REQUIRE((map.values[index] < 0.0F) == is_inside);
    }
  }
}

TEST_CASE("The distance map of a solid is 1-Lipschitz between any two voxels",
          "[geometry][distance_map]") {
  const TriangleMesh mesh = torus(0.05, 0.02, 40, 20);
  const VoxelLattice lattice =
      lattice_around(bounding_box(mesh), {.resolution = 24, .margin = 0.02});
  const VoxelGrid grid = voxelize(MeshQuery(mesh), lattice, surface_patches(mesh, lattice));
  const SignedDistanceMap map = signed_distance_map(grid);
  // The loop tries every step to a neighbor, diagonal ones too. The surface is partial voxels
  // without a gap, so that the sign changes through zero; across a diagonal it need not, and
  // magnitudes are compared.
  for (std::int64_t index = 0; index < lattice.num_voxels(); ++index) {
    const Eigen::Vector3i voxel = lattice.voxel(index);
    for (int n = 0; n < 27; ++n) {
      const Eigen::Vector3i step(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      const Eigen::Vector3i next = voxel + step;
      if (!lattice.contains(next)) continue;
      const double distance = step.cast<double>().norm();
      const bool is_straight = step.squaredNorm() == 1;
      const double change = is_straight
                                ? std::abs(map.at(next) - map.at(voxel))
                                : std::abs(std::abs(map.at(next)) - std::abs(map.at(voxel)));
      REQUIRE(change <= distance + 1e-5);  // Half an ulp is of values up to 64.
    }
    const VoxelClass c = grid.classes[index];
    REQUIRE((map.values[index] > 0) == (c == VoxelClass::Empty));
    REQUIRE((map.values[index] < 0) == (c == VoxelClass::Full));
  }
  // These are pairs that are far apart.
  Random random(22);
  for (int i = 0; i < 20000; ++i) {
    const auto any = [&] {
      return static_cast<std::int64_t>(
          random.index(static_cast<std::uint64_t>(lattice.num_voxels())));
    };
    const std::int64_t a = any();
    const std::int64_t b = any();
    const double distance = (lattice.voxel(a) - lattice.voxel(b)).cast<double>().norm();
    REQUIRE(std::abs(std::abs(map.values[a]) - std::abs(map.values[b])) <= distance + 1e-5);
  }
}

TEST_CASE("At 256 voxels along the longest axis the distance map is that of single voxels",
          "[geometry][distance_map]") {
  // In a flat box of 256 x 40 x 20 voxels a few are partial, and the reference is brute force over
  // those few.
  Random random(23);
  VoxelGrid grid = grid_of({256, 40, 20}, VoxelClass::Empty);
  std::vector<Eigen::Vector3i> partial;
  for (int i = 0; i < 40; ++i) {
    const auto index = static_cast<std::int64_t>(random.index(256 * 40 * 20));
    grid.classes[index] = VoxelClass::Partial;
    partial.push_back(grid.lattice.voxel(index));
  }
  const SignedDistanceMap map = signed_distance_map(grid);
  for (std::int64_t index = 0; index < grid.lattice.num_voxels(); ++index) {
    int best = std::numeric_limits<int>::max();
    for (const Eigen::Vector3i& p : partial) {
      best = std::min(best, (grid.lattice.voxel(index) - p).squaredNorm());
    }
    REQUIRE(map.values[index] == static_cast<float>(std::sqrt(static_cast<double>(best))));
  }
}

TEST_CASE("A point takes its voxel's distance, beyond the lattice more",
          "[geometry][distance_map]") {
  VoxelGrid grid = grid_of({3, 3, 3}, VoxelClass::Empty);
  grid.classes[grid.lattice.index({0, 1, 1})] = VoxelClass::Partial;
  const SignedDistanceMap map = signed_distance_map(grid);
  CHECK(map.at(Eigen::Vector3d(2.5, 1.5, 1.5)) == 2.0F);
  CHECK(map.at(Eigen::Vector3d(2.999, 1.001, 1.999)) == 2.0F);
  CHECK(map.at(Eigen::Vector3d(6.5, 1.5, 1.5)) == 6.0F);
  CHECK(map.at(Eigen::Vector3d(-3.5, 1.5, 1.5)) == 4.0F);
  // It is from (6, 5, 2) to (0, 1, 1).
  CHECK(map.at(Eigen::Vector3d(6.5, 5.5, 2.5)) == std::sqrt(53.0F));
  CHECK(map.at(Eigen::Vector3d(1e9, 1.5, 1.5)) == 1e9F);
}

TEST_CASE("Beyond the lattice distances are bounds from below that a larger lattice confirms",
          "[geometry][distance_map]") {
  for (const TriangleMesh& mesh : {box({0.05, 0.04, 0.03}), torus(0.04, 0.012, 40, 20)}) {
    const VoxelLattice inner = lattice_around(
        bounding_box(mesh), {.resolution = 16, .margin = 2 * longest_extent(mesh) / 16});
    const VoxelGrid grid = voxelize(MeshQuery(mesh), inner, surface_patches(mesh, inner));
    const SignedDistanceMap small = signed_distance_map(grid);
    constexpr int kMore = 12;  // It is in voxels to every side.
    VoxelGrid padded{{inner.origin - Eigen::Vector3d::Constant(kMore * inner.voxel_size),
                      inner.voxel_size, inner.counts.array() + 2 * kMore},
                     {}};
    padded.classes.assign(static_cast<std::size_t>(padded.lattice.num_voxels()), VoxelClass::Empty);
    for (std::int64_t index = 0; index < inner.num_voxels(); ++index) {
      const Eigen::Vector3i voxel = inner.voxel(index).array() + kMore;
      padded.classes[padded.lattice.index(voxel)] = grid.classes[index];
    }
    const SignedDistanceMap large = signed_distance_map(padded);
    const VoxelLattice& lattice = large.lattice;
    std::vector<float> bounds;
    for (std::int64_t index = 0; index < lattice.num_voxels(); ++index) {
      bounds.push_back(small.at(lattice.center(lattice.voxel(index))));
    }
    int num_equal_beyond = 0;
    for (std::int64_t index = 0; index < lattice.num_voxels(); ++index) {
      const Eigen::Vector3i voxel = lattice.voxel(index);
      const float bound = bounds[index];
      REQUIRE(bound <= large.values[index]);
      if (inner.contains(voxel.array() - kMore)) {
        REQUIRE(bound == large.values[index]);
      } else {
        REQUIRE(bound >= 2.0F);  // Of a margin of two voxels the tie rule may take one.
        num_equal_beyond += bound == large.values[index];
      }
      for (int axis = 0; axis < 3; ++axis) {
        if (voxel[axis] + 1 == lattice.counts[axis]) continue;
        const float next = bounds[lattice.index(voxel + Eigen::Vector3i::Unit(axis))];
        REQUIRE(std::abs(next - bound) <= 1.0F + 1e-5F);  // This is half an ulp of values up to 64.
      }
    }
    CHECK(num_equal_beyond > 1000);
  }
}

TEST_CASE("A lattice too long for exact squares is refused", "[geometry][distance_map]") {
  CHECK_THROWS_AS(signed_distance_map(grid_of({16385, 1, 1}, VoxelClass::Empty)), InvalidInput);
}

}  // namespace test_distance_map
