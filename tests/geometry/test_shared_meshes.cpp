#include <cmath>
#include <string>
#include <vector>

#include "graspfit/geometry/distance_map.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "graspfit/geometry/mesh_analysis.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/random.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"
#include "support/test_data.hpp"

// Real meshes that do not belong to the repository; skipped where they are not there.

using namespace graspfit::geometry;

namespace {

struct Expected {
  const char* file;
  const char* outcome;  ///< Steps of the repair, "good", or the start of the refusal.
};

std::string outcome_of(const TriangleMesh& mesh) {
  try {
    const RepairedMesh repaired = repair_mesh(mesh);
    if (repaired.steps.empty()) return "good";
    std::string text;
    for (const RepairStep& step : repaired.steps) {
      text += (text.empty() ? "" : ", ") + step.what + " " + std::to_string(step.count);
    }
    return text;
  } catch (const Error& error) {
    return std::string("refused: ") + error.what();
  }
}

// A solid's voxels, patches and queries have to agree with each other.
void check_solid(const TriangleMesh& mesh) {
  const MeshQuery query(mesh);
  const VoxelLattice lattice = lattice_around(bounding_box(mesh), {.resolution = 30});
  const auto patches = surface_patches(mesh, lattice);
  double area = 0.0;
  for (const SurfacePatch& patch : patches) {
    area += patch.area;
    REQUIRE(patch.area > 0.0);
    REQUIRE(std::sqrt(query.closest_point(patch.centroid).squared_distance) <
            1e-12 * longest_extent(mesh));
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

void check_all(const std::vector<Expected>& meshes) {
  for (const auto& [file, outcome] : meshes) {
    const auto path = graspfit::testing::find_data(std::string("meshes/") + file);
    if (!path)
      GRASPFIT_SKIP_TEST(std::string("meshes/") + file + " is not there; set GRASPFIT_DATA");
    INFO(file);
    const TriangleMesh mesh = read_mesh(*path).mesh;
    const std::string found = outcome_of(mesh);
    CHECK_THAT(found, Catch::StartsWith(outcome));
    if (!found.starts_with("refused")) check_solid(repair_mesh(mesh).mesh);
  }
}

}  // namespace

TEST_CASE("Closed meshes of the paper's objects need no repair", "[geometry][data]") {
  check_all({{"paper/armadillo.off", "good"},   {"paper/ball.obj", "good"},
             {"paper/bimba.obj", "good"},       {"paper/bottle.obj", "good"},
             {"paper/buddha_head.obj", "good"}, {"paper/bunny.off", "good"},
             {"paper/cage_frame.stl", "good"},  {"paper/dinosaur.off", "good"},
             {"paper/duck.obj", "good"},        {"paper/flower_pot.obj", "good"},
             {"paper/horse.off", "good"},       {"paper/kitten.obj", "good"},
             {"paper/max_planck.obj", "good"},  {"paper/mug.obj", "good"},
             {"paper/octopus.off", "good"},     {"paper/pegaso.off", "good"},
             {"paper/shark.obj", "good"},       {"paper/teddy.off", "good"},
             {"paper/torus.obj", "good"},       {"paper/toy_car_lowpoly.obj", "good"}});
}

TEST_CASE("Everyday meshes are good or repaired", "[geometry][data]") {
  check_all({{"everyday/bamboo_pen.obj", "good"},
             {"everyday/banana.obj", "good"},
             {"everyday/bike_frame.stl", "good"},
             {"everyday/extra_large_clamp.obj", "good"},
             {"everyday/hammer.obj", "good"},
             {"everyday/phillips_screwdriver.obj", "good"},
             {"everyday/bowl.ply", "removed degenerate faces"},
             {"everyday/mustard_bottle.obj", "removed degenerate faces"},
             {"everyday/power_drill.ply", "removed degenerate faces"},
             {"everyday/tomato_soup_can.obj", "removed degenerate faces"}});
}

TEST_CASE("Meshes with known defects are repaired or refused in words", "[geometry][data]") {
  check_all({{"paper/bowling_pin.obj", "split non-manifold vertices 3, filled holes 5"},
             {"paper/squirrel.off", "split non-manifold vertices"},
             {"paper/cage.obj", "turned parts 1"},
             {"paper/toy_car.obj", ""}});
}
