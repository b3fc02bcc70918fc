#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/distance_map.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/mesh_repair.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"
#include "support/test_data.hpp"

namespace test_shared_meshes {

// These are real meshes that do not belong to the repository; the tests are skipped where they are
// not there.

using namespace graspfit::base;
using namespace graspfit::geometry;

namespace {

/// One line of the outcome table.
struct Expected {
  std::string file;     ///< Below meshes/.
  std::string outcome;  ///< good, repaired or refused.
  std::string steps;    ///< Of the repair, with their counts, "; " between them.
  std::string parts;    ///< After it.
  std::string volume;   ///< Of the solid, in the file's unit, cubed.
};

std::vector<Expected> read_table() {
  std::istringstream text(read_file(graspfit::testing::source_directory() /
                                    "tests/geometry/assets/shared_mesh_outcomes.csv"));
  std::string line;
  std::getline(text, line);
  REQUIRE(line == "file,outcome,steps,parts,volume");
  std::vector<Expected> table;
  while (std::getline(text, line)) {
    std::istringstream cells(line);
    Expected row;
    for (std::string* cell : {&row.file, &row.outcome, &row.steps, &row.parts, &row.volume}) {
      std::getline(cells, *cell, ',');
    }
    table.push_back(row);
  }
  return table;
}

// Checks that a solid's voxels, patches and queries agree with each other.
void check_solid(const TriangleMesh& mesh) {
  const MeshQuery query(mesh);
  const VoxelLattice lattice = lattice_around(bounding_box(mesh), {.resolution = 30});
  const auto patches = surface_patches(mesh, lattice);
  double area = 0.0;
  for (const SurfacePatch& patch : patches) {
    area += patch.area;
    REQUIRE(patch.area > 0.0);
    // The closest point of a sliver is rounded more: 1.5e-11 of the extent on multidex/camera.stl.
    REQUIRE(std::sqrt(query.closest_point(patch.centroid).squared_distance) <
            3e-11 * longest_extent(mesh));
  }
  CHECK(area == Approx(surface_area(mesh)).epsilon(1e-12));
  const VoxelGrid grid = voxelize(query, lattice, patches);
  CHECK(grid.count(VoxelClass::Partial) == static_cast<std::int64_t>(patches.size()));
  const SignedDistanceMap map = signed_distance_map(grid);
  Random random(71);
  for (int i = 0; i < 2000; ++i) {
    const std::int64_t index =
        static_cast<std::int64_t>(random.index(static_cast<std::uint64_t>(lattice.num_voxels())));
    const Eigen::Vector3d center = lattice.center(lattice.voxel(index));
    const bool is_inside = query.containment(center) == Containment::Inside;
    if (grid.classes[index] == VoxelClass::Partial) continue;
    REQUIRE((grid.classes[index] == VoxelClass::Full) == is_inside);
    // The surface passes within the nearest partial voxel: its center is map voxels away, a corner
    // half a diagonal less.
    const double distance = std::abs(query.signed_distance(center)) / lattice.voxel_size;
    REQUIRE(distance <= std::abs(map.values[index]) + 0.867);
    REQUIRE(distance >= std::abs(map.values[index]) - 0.867);
  }
}

void check_row(const Expected& expected, const TriangleMesh& mesh) {
  if (expected.outcome == "refused") {
    CHECK_THROWS_AS(repair_mesh(mesh), Error);
    return;
  }
  const RepairedMesh repaired = repair_mesh(mesh);
  std::string steps;
  for (const RepairStep& step : repaired.steps) {
    steps += (steps.empty() ? "" : "; ") + step.what + " " + std::to_string(step.count);
    CHECK(step.hausdorff_bound >= 0.0);
    CHECK(step.hausdorff_bound < longest_extent(mesh));
  }
  CHECK(steps == expected.steps);
  CHECK(expected.outcome == (steps.empty() ? "good" : "repaired"));
  CHECK(std::to_string(repaired.after.num_parts) == expected.parts);
  CHECK(repaired.after.is_outward);
  CHECK(repaired.after.is_manifold);
  // These are sums of 1e5 faces, in any order of evaluation.
  CHECK(mass_properties(repaired.mesh).volume == Approx(std::stod(expected.volume)).epsilon(1e-9));
  check_solid(repaired.mesh);
}

}  // namespace

TEST_CASE("Every shared mesh has the outcome of the table", "[geometry][data]") {
  for (const Expected& expected : read_table()) {
    INFO(expected.file);
    const auto path = graspfit::testing::find_data("meshes/" + expected.file);
    if (!path) GRASPFIT_SKIP_TEST("meshes/" + expected.file + " is not there; set GRASPFIT_DATA");
    check_row(expected, read_mesh(*path).mesh);
  }
}

TEST_CASE("Every shared mesh is in the table", "[geometry][data]") {
  const auto sources = graspfit::testing::find_data("meshes/SOURCES.md");
  if (!sources) GRASPFIT_SKIP_TEST("meshes/SOURCES.md is not there; set GRASPFIT_DATA");
  const std::filesystem::path folder = sources->parent_path();
  std::set<std::string> listed;
  for (const Expected& expected : read_table()) listed.insert(expected.file);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || entry.path().extension() == ".md") continue;
    const std::string name = entry.path().lexically_relative(folder).generic_string();
    INFO(name);
    CHECK(listed.contains(name));
  }
}

}  // namespace test_shared_meshes
