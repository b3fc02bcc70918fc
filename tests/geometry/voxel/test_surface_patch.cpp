#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "support/catch.hpp"

namespace test_surface_patch {

using namespace graspfit::base;
using namespace graspfit::geometry;

namespace {

VoxelLattice unit_lattice(int count, double origin = 0.0) {
  return {Eigen::Vector3d::Constant(origin), 1.0, Eigen::Vector3i::Constant(count)};
}

double sum_of_areas(const std::vector<SurfacePatch>& patches) {
  return std::accumulate(patches.begin(), patches.end(), 0.0,
                         [](double sum, const SurfacePatch& p) { return sum + p.area; });
}

}  // namespace

TEST_CASE("The face of a box that lies in a voxel plane belongs to the higher voxel",
          "[geometry][surface_patch]") {
  // The unit cube is in the middle voxel of 3 x 3 x 3. Its low faces lie in planes 1, of which that
  // voxel is the higher side; each high face lies in a plane 2 and goes to the next voxel.
  TriangleMesh cube = box({1.0, 1.0, 1.0});
  for (auto& vertex : cube.vertices) vertex.array() += 1.5;
  const VoxelLattice lattice = unit_lattice(3);
  const auto patches = surface_patches(cube, lattice);
  std::map<std::int64_t, double> areas;
  for (const SurfacePatch& patch : patches) areas[patch.voxel] = patch.area;
  const std::map<std::int64_t, double> expected = {{lattice.index({1, 1, 1}), 3.0},
                                                   {lattice.index({2, 1, 1}), 1.0},
                                                   {lattice.index({1, 2, 1}), 1.0},
                                                   {lattice.index({1, 1, 2}), 1.0}};
  CHECK(areas == expected);
}

TEST_CASE("Patch areas of a closed mesh sum to the area of the mesh", "[geometry][surface_patch]") {
  for (const TriangleMesh& mesh :
       {ball(0.07, 3), torus(0.05, 0.02, 48, 24), box({0.3, 0.2, 0.15}), capsule(0.02, 0.1, 24)}) {
    for (const int resolution : {4, 13, 30}) {
      const auto patches =
          surface_patches(mesh, lattice_around(bounding_box(mesh), {.resolution = resolution}));
      CHECK(sum_of_areas(patches) == Approx(surface_area(mesh)).epsilon(1e-12));
    }
  }
}

TEST_CASE("Pieces of a face have vector areas that sum to its own", "[geometry][surface_patch]") {
  const TriangleMesh mesh = torus(0.05, 0.02, 30, 15);
  const auto pieces = clip_by_voxels(mesh, lattice_around(bounding_box(mesh), {}));
  std::vector<Eigen::Vector3d> sums(mesh.faces.size(), Eigen::Vector3d::Zero());
  for (const auto& [voxel, piece] : pieces) {
    for (std::size_t i = 2; i < piece.polygon.size(); ++i) {
      sums[piece.face] +=
          0.5 *
          (piece.polygon[i - 1] - piece.polygon[0]).cross(piece.polygon[i] - piece.polygon[0]);
    }
  }
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const Eigen::Vector3d whole = vector_area(mesh, face);
    // Coordinates of 0.07 are rounded at 1e-17 against faces of 0.01: 1e-15 relative, in a few
    // hundred pieces.
    CHECK((sums[face] - whole).norm() <= 1e-12 * whole.norm());
  }
}

TEST_CASE("A patch's centroid lies on the patch and in its voxel", "[geometry][surface_patch]") {
  const TriangleMesh mesh = ball(0.05, 3);
  const MeshQuery query(mesh);
  const VoxelLattice lattice = lattice_around(bounding_box(mesh), {.resolution = 8});
  for (const auto averaging : {PatchAveraging::AreaWeighted, PatchAveraging::Plain}) {
    for (const SurfacePatch& patch : surface_patches(mesh, lattice, {averaging})) {
      CHECK(query.closest_point(patch.centroid).squared_distance < 1e-30);
      const Eigen::Vector3i voxel = lattice.voxel(patch.voxel);
      CHECK((patch.centroid - lattice.center(voxel)).cwiseAbs().maxCoeff() <=
            0.5 * lattice.voxel_size * (1 + 1e-12));
      REQUIRE(patch.has_normal);
      CHECK(patch.outward_normal.norm() == Approx(1.0));
      // A voxel is an eighth of the diameter, so that the normal varies little about the radial
      // direction.
      CHECK(patch.outward_normal.dot(patch.centroid.normalized()) > 0.9);
      CHECK(std::is_sorted(patch.faces.begin(), patch.faces.end()));
    }
  }
}

TEST_CASE("Both sides of a thin plate in one voxel leave no normal", "[geometry][surface_patch]") {
  TriangleMesh plate = box({4.0, 4.0, 0.1});
  for (auto& vertex : plate.vertices) vertex.array() += 3.5;
  const VoxelLattice lattice = unit_lattice(7);
  int without = 0;
  for (const SurfacePatch& patch : surface_patches(plate, lattice)) {
    const Eigen::Vector3i voxel = lattice.voxel(patch.voxel);
    if (voxel[0] >= 2 && voxel[0] <= 4 && voxel[1] >= 2 && voxel[1] <= 4) {
      CHECK_FALSE(patch.has_normal);
      CHECK(patch.outward_normal == Eigen::Vector3d::Zero());
      CHECK(patch.area == Approx(2.0));
      ++without;
    }
  }
  CHECK(without == 9);
}

TEST_CASE("Area weighting and plain averaging differ as documented", "[geometry][surface_patch]") {
  // In one voxel are a triangle of area 1/2 facing +z and one of area 1/8 facing +x.
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0.5}, {1, 0, 0.5},   {0, 1, 0.5},
                   {0.5, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}};
  mesh.faces = {{0, 1, 2}, {3, 4, 5}};
  const VoxelLattice lattice = unit_lattice(2);
  const auto weighted = surface_patches(mesh, lattice, {PatchAveraging::AreaWeighted});
  const auto plain = surface_patches(mesh, lattice, {PatchAveraging::Plain});
  REQUIRE(weighted.size() == 1);
  REQUIRE(plain.size() == 1);
  CHECK(weighted[0].area == Approx(0.625));
  CHECK(plain[0].area == Approx(0.625));
  const Eigen::Vector3d slanted = Eigen::Vector3d(0.125, 0.0, 0.5).normalized();
  CHECK((weighted[0].outward_normal - slanted).norm() < 1e-14);
  CHECK((plain[0].outward_normal - Eigen::Vector3d(1, 0, 1).normalized()).norm() < 1e-14);
}

TEST_CASE("A patch has both normals and the center of area, whatever the options",
          "[geometry][surface_patch]") {
  const TriangleMesh mesh = torus(0.05, 0.02, 24, 12);
  const VoxelLattice lattice = lattice_around(bounding_box(mesh), {.resolution = 10});
  const auto weighted = surface_patches(mesh, lattice, {PatchAveraging::AreaWeighted});
  const auto plain = surface_patches(mesh, lattice, {PatchAveraging::Plain});
  const auto pieces = clip_by_voxels(mesh, lattice);
  auto piece = pieces.begin();
  REQUIRE(weighted.size() == plain.size());
  for (std::size_t i = 0; i < weighted.size(); ++i) {
    const SurfacePatch& patch = weighted[i];
    // The averages follow from their definitions.
    double area = 0.0;
    double count = 0.0;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    Eigen::Vector3d vector_sum = Eigen::Vector3d::Zero();
    Eigen::Vector3d normals = Eigen::Vector3d::Zero();
    for (; piece != pieces.end() && piece->voxel == patch.voxel; ++piece) {
      const Eigen::Vector3d normal = face_normal(mesh, static_cast<std::size_t>(piece->piece.face));
      area += piece->piece.area;
      moment += piece->piece.area * piece->piece.centroid;
      vector_sum += piece->piece.area * normal;
      normals += normal;
      count += 1.0;
    }
    CHECK(patch.area == Approx(area).epsilon(1e-14));
    CHECK((patch.area_centroid - moment / area).norm() < 1e-15);
    CHECK((patch.area_weighted_normal - vector_sum / area).norm() < 1e-14);
    CHECK((patch.plain_normal - normals / count).norm() < 1e-14);
    CHECK(plain[i].area == patch.area);
    CHECK(plain[i].area_centroid == patch.area_centroid);
    CHECK(plain[i].area_weighted_normal == patch.area_weighted_normal);
    CHECK(plain[i].plain_normal == patch.plain_normal);
    CHECK(patch.outward_normal == patch.area_weighted_normal / patch.area_weighted_normal.norm());
    CHECK(plain[i].outward_normal == patch.plain_normal / patch.plain_normal.norm());
  }
  CHECK(piece == pieces.end());
}

TEST_CASE("A patch's centroid is the nearest point of all its pieces to their mean",
          "[geometry][surface_patch]") {
  // The reference visits every piece; the fast path excludes most by a ball about each.
  for (const TriangleMesh& mesh : {ball(0.05, 4), torus(0.05, 0.02, 60, 30)}) {
    const VoxelLattice lattice = lattice_around(bounding_box(mesh), {.resolution = 6});
    const auto pieces = clip_by_voxels(mesh, lattice);
    auto piece = pieces.begin();
    for (const SurfacePatch& patch : surface_patches(mesh, lattice)) {
      TriangleMesh here;
      for (; piece != pieces.end() && piece->voxel == patch.voxel; ++piece) {
        const auto& polygon = piece->piece.polygon;
        for (std::size_t i = 2; i < polygon.size(); ++i) {
          const auto n = static_cast<std::int32_t>(here.vertices.size());
          here.vertices.insert(here.vertices.end(), {polygon[0], polygon[i - 1], polygon[i]});
          here.faces.push_back({n, n + 1, n + 2});
        }
      }
      const double least = MeshQuery(here).closest_point(patch.area_centroid).squared_distance;
      CHECK(std::sqrt(least) ==
            Approx((patch.centroid - patch.area_centroid).norm()).margin(1e-15));
    }
  }
}

TEST_CASE("At 256 voxels along the longest axis of a flat body the patches hold its whole surface",
          "[geometry][surface_patch]") {
  TriangleMesh mesh = ball(0.1, 4);
  for (auto& vertex : mesh.vertices) vertex = vertex.cwiseProduct(Eigen::Vector3d(0.4, 1.0, 0.2));
  const VoxelLattice lattice = lattice_around(bounding_box(mesh), {.resolution = 256});
  // 0.4 and 0.2 of 256 are 102.4 and 51.2, which are rounded up, with a margin of one voxel on each
  // side.
  CHECK(lattice.counts == Eigen::Vector3i(105, 258, 54));
  const auto patches = surface_patches(mesh, lattice);
  CHECK(sum_of_areas(patches) == Approx(surface_area(mesh)).epsilon(1e-12));
  const VoxelGrid grid = voxelize(MeshQuery(mesh), lattice, patches);
  CHECK(grid.count(VoxelClass::Partial) == static_cast<std::int64_t>(patches.size()));
}

TEST_CASE("Surface voxels are those that have a patch", "[geometry][surface_patch]") {
  for (const TriangleMesh& mesh :
       {ball(0.07, 3), torus(0.05, 0.02, 48, 24), box({0.3, 0.2, 0.15}), capsule(0.02, 0.1, 24)}) {
    for (const int resolution : {4, 13, 30}) {
      const VoxelLattice lattice = lattice_around(bounding_box(mesh), {.resolution = resolution});
      const auto patches = surface_patches(mesh, lattice);
      std::vector<std::int64_t> expected;
      for (const SurfacePatch& patch : patches) expected.push_back(patch.voxel);
      const auto voxels = surface_voxels(mesh, lattice);
      CHECK(voxels == expected);
      const MeshQuery object(mesh);
      CHECK(voxelize(object, lattice, voxels).classes ==
            voxelize(object, lattice, patches).classes);
    }
  }
  const TriangleMesh far_away =
      transformed(box({1.0, 1.0, 1.0}), RigidTransform(Eigen::Translation3d(9.0, 0.0, 0.0)));
  CHECK_THROWS_AS(surface_voxels(far_away, unit_lattice(3)), InvalidInput);
}

TEST_CASE("Patches do not depend on the order of the faces", "[geometry][surface_patch]") {
  // The torus is turned, since in a symmetric position two points of a patch can be equally near to
  // its mean.
  const RigidTransform X(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  const TriangleMesh mesh = transformed(torus(0.05, 0.02, 24, 12), X);
  TriangleMesh reversed = mesh;
  std::reverse(reversed.faces.begin(), reversed.faces.end());
  const VoxelLattice lattice = lattice_around(bounding_box(mesh), {.resolution = 12});
  const auto a = surface_patches(mesh, lattice);
  const auto b = surface_patches(reversed, lattice);
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i].voxel == b[i].voxel);
    CHECK(a[i].area == Approx(b[i].area).epsilon(1e-13));
    CHECK((a[i].centroid - b[i].centroid).norm() < 1e-15);
  }
}

TEST_CASE("Patches ascend by voxel in layers of more than 2^22 voxels",
          "[geometry][surface_patch]") {
  const VoxelLattice lattice{Eigen::Vector3d::Zero(), 1.0, {2100, 2100, 1}};
  Random random(31);
  TriangleMesh mesh;
  std::set<std::int64_t> expected;
  for (std::int32_t i = 0; i < 300; ++i) {
    const Eigen::Vector3i voxel(static_cast<int>(random.index(2100)),
                                static_cast<int>(random.index(2100)), 0);
    expected.insert(lattice.index(voxel));
    for (const Eigen::Vector3d& place :
         {Eigen::Vector3d(0.3, 0.3, 0.5), {0.6, 0.3, 0.5}, {0.3, 0.6, 0.5}}) {
      mesh.vertices.push_back(voxel.cast<double>() + place);
    }
    mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  std::vector<std::int64_t> found;
  for (const SurfacePatch& patch : surface_patches(mesh, lattice)) found.push_back(patch.voxel);
  CHECK(found == std::vector<std::int64_t>(expected.begin(), expected.end()));
}

TEST_CASE("A mesh that leaves the lattice is refused", "[geometry][surface_patch]") {
  TriangleMesh cube = box({1.0, 1.0, 1.0});
  CHECK_THROWS_AS(surface_patches(cube, unit_lattice(3)), InvalidInput);
  // High faces are in the last plane.
  for (auto& vertex : cube.vertices) vertex.array() += 2.5;
  CHECK_THROWS_WITH(surface_patches(cube, unit_lattice(3)),
                    graspfit::testing::Contains("leaves the lattice"));
  CHECK_NOTHROW(surface_patches(cube, unit_lattice(4)));
  CHECK_THROWS_AS(surface_patches(cube, VoxelLattice{}), InvalidInput);
  CHECK_THROWS_WITH(surface_patches(cube, unit_lattice(1291)), graspfit::testing::Contains("2^31"));
}

TEST_CASE("A mesh without faces or of degenerate faces has no patches",
          "[geometry][surface_patch]") {
  TriangleMesh mesh;
  CHECK(surface_patches(mesh, unit_lattice(2)).empty());
  mesh.vertices = {{0.1, 0.1, 0.1}, {0.3, 0.3, 0.3}, {0.5, 0.5, 0.5}};
  mesh.faces = {{0, 1, 2}, {0, 0, 1}, {1, 1, 1}};
  CHECK(surface_patches(mesh, unit_lattice(2)).empty());
}

}  // namespace test_surface_patch
