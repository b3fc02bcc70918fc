#include <cmath>
#include <string>
#include <vector>

#include "graspfit/geometry/distance_map.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/mesh_repair.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "support/catch.hpp"
#include "support/openvdb_field.hpp"
#include "support/skip.hpp"
#include "support/test_data.hpp"

namespace test_against_openvdb {

// These tests compare voxel classes, distance map and signed distance with those of an independent
// library.

using namespace graspfit::geometry;
using graspfit::testing::OpenVdbMesh;

namespace {

// A single precision coordinate below 128 voxels is within 2^-18 voxels of its exact value; three
// of them move a point by at most sqrt(3) times that, and so change no distance by more. Distances
// below 4 voxels, their squares and their roots add a few times 2^-23.
constexpr double kSinglePrecision = 1.8 * 0x1p-18 + 8 * 0x1p-23;  // [voxels]

// This is the distance from the center of a voxel to its corner. The nearest point of the surface
// lies in a (closed) partial voxel, and each partial voxel holds some of the surface, so that the
// distance between centers and the distance to the surface differ by at most this much, either way.
const double kHalfDiagonal = std::sqrt(3.0) / 2;  // [voxels]

// OpenVDB uses single precision, so both get it.
TriangleMesh in_single_precision(TriangleMesh mesh) {
  for (Eigen::Vector3d& v : mesh.vertices) v = v.cast<float>().cast<double>();
  return mesh;
}

// OpenVDB computes the distance to every face near a voxel only up to one voxel from the surface.
// Further out a voxel takes the best of its neighbors' faces: a distance to *some* face, which may
// be too large.
constexpr double kExactBand = 1.0;  // [voxels]

void compare(const TriangleMesh& mesh, int resolution) {
  const MeshQuery query(mesh);
  const VoxelLattice lattice = lattice_around(bounding_box(mesh), {.resolution = resolution});
  REQUIRE(lattice.counts.maxCoeff() < 128);
  const VoxelGrid grid = voxelize(query, lattice, surface_patches(mesh, lattice));
  const SignedDistanceMap map = signed_distance_map(grid);
  const OpenVdbMesh other(mesh, lattice);
  const auto field = other.signed_distance_field();
  const auto distances = other.unsmoothed_distance_field();

  int num_sides = 0, num_exact = 0, num_outer = 0;
  int num_wrong_sides = 0, num_wrong_exact = 0, num_wrong_outer = 0, num_wrong_map = 0;
  for (std::int64_t i = 0; i < lattice.num_voxels(); ++i) {
    const Eigen::Vector3i voxel = lattice.voxel(i);
    const double in_map = std::abs(map.values[i]);
    if (in_map > 1.0 + kHalfDiagonal) {  // The surface is more than one voxel away.
      ++num_sides;
      num_wrong_sides += (grid.classes[i] == VoxelClass::Full) != (field.at(voxel) < 0.0);
    }
    const double theirs = std::abs(distances.at(voxel));
    if (theirs > 3.0 - kSinglePrecision) continue;  // It is beyond their band.
    const double ours = query.signed_distance(lattice.center(voxel)) / lattice.voxel_size;
    if (std::abs(ours) <= kExactBand) {
      ++num_exact;
      num_wrong_exact += std::abs(std::abs(ours) - theirs) > kSinglePrecision;
      num_wrong_map += in_map < theirs - kHalfDiagonal - kSinglePrecision;
    } else {
      ++num_outer;
      num_wrong_outer += theirs < std::abs(ours) - kSinglePrecision;
      num_wrong_sides += (ours < 0.0) != (field.at(voxel) < 0.0);
    }
    num_wrong_map += in_map > theirs + kHalfDiagonal + kSinglePrecision;
  }
  CHECK(num_sides > 1000);
  CHECK(num_exact > 500);
  CHECK(num_outer > 500);
  CHECK(num_wrong_sides == 0);
  CHECK(num_wrong_exact == 0);
  CHECK(num_wrong_outer == 0);
  CHECK(num_wrong_map == 0);
}

// OpenVDB finds the outside by a flood that a mouth narrower than a voxel can stop: at 40 voxels it
// counts the shark's mouth, 1.3 voxels deep, as inside. At this resolution no mesh has such a
// pocket.
constexpr int kSharedResolution = 48;

void compare_shared(const std::vector<const char*>& files) {
  for (const char* name : files) {
    const auto file = graspfit::testing::find_data(std::string("meshes/") + name);
    if (!file) {
      GRASPFIT_SKIP_TEST(std::string("meshes/") + name + " is not there; set GRASPFIT_DATA");
    }
    INFO(name);
    compare(in_single_precision(repair_mesh(read_mesh(*file).mesh).mesh), kSharedResolution);
  }
}

}  // namespace

TEST_CASE("Classes, distance map and signed distance agree with OpenVDB on packaged meshes",
          "[geometry][openvdb]") {
  for (const char* name : {"bunny00.off", "armadillo.off", "dino.off"}) {
    const auto file = graspfit::testing::packaged_mesh(name);
    if (!file) {
      GRASPFIT_SKIP_TEST(std::string(name) +
                         " of libcgal-demo is not unpacked; run ./quickstart once");
    }
    INFO(name);
    compare(in_single_precision(repair_mesh(read_mesh(*file).mesh).mesh), 64);
  }
}

TEST_CASE("Classes, distance map and signed distance agree with OpenVDB on the paper's objects",
          "[geometry][openvdb][data]") {
  compare_shared({"paper/armadillo.off",   "paper/ball.obj",
                  "paper/bimba.obj",       "paper/bottle.obj",
                  "paper/buddha_head.obj", "paper/bunny.off",
                  "paper/cage_frame.stl",  "paper/dinosaur.off",
                  "paper/duck.obj",        "paper/flower_pot.obj",
                  "paper/horse.off",       "paper/kitten.obj",
                  "paper/max_planck.obj",  "paper/mug.obj",
                  "paper/octopus.off",     "paper/pegaso.off",
                  "paper/shark.obj",       "paper/teddy.off",
                  "paper/torus.obj",       "paper/toy_car_lowpoly.obj"});
}

TEST_CASE("Classes, distance map and signed distance agree with OpenVDB on everyday objects",
          "[geometry][openvdb][data]") {
  compare_shared({"everyday/bamboo_pen.obj", "everyday/banana.obj", "everyday/bike_frame.stl",
                  "everyday/bowl.ply", "everyday/extra_large_clamp.obj", "everyday/hammer.obj",
                  "everyday/mustard_bottle.obj", "everyday/phillips_screwdriver.obj",
                  "everyday/power_drill.ply", "everyday/tomato_soup_can.obj"});
}

}  // namespace test_against_openvdb
