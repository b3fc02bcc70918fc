#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "geometry/rational_clip.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/random.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "support/catch.hpp"

using namespace graspfit::geometry;
using graspfit::testing::RationalPolygon;

namespace {

VoxelLattice unit_lattice(int count, double origin = 0.0) {
  return {Eigen::Vector3d::Constant(origin), 1.0, Eigen::Vector3i::Constant(count)};
}

// Exact part of each triangle in each voxel by the tie rule, from the definition.
std::map<std::pair<std::int64_t, std::int32_t>, CGAL::Gmpq> brute_force(
    const TriangleMesh& mesh, const VoxelLattice& lattice) {
  std::map<std::pair<std::int64_t, std::int32_t>, CGAL::Gmpq> result;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const auto triangle = corners(mesh, face);
    Eigen::AlignedBox3d box;
    for (const auto& corner : triangle) box.extend(corner);
    const RationalPolygon whole(triangle);
    if (!whole.has_area()) continue;
    for (std::int64_t index = 0; index < lattice.num_voxels(); ++index) {
      const Eigen::Vector3i voxel = lattice.voxel(index);
      RationalPolygon piece = whole;
      bool is_here = true;
      for (int axis = 0; axis < 3 && is_here; ++axis) {
        const double lower = lattice.plane(axis, voxel[axis]);
        const double upper = lattice.plane(axis, voxel[axis] + 1);
        is_here =
            box.min()[axis] <= upper && box.max()[axis] >= lower && !whole.is_in_plane(axis, upper);
      }
      for (int axis = 0; axis < 3 && is_here; ++axis) {
        piece.clip_slab(axis, lattice.plane(axis, voxel[axis]),
                        lattice.plane(axis, voxel[axis] + 1));
        is_here = piece.has_area();
      }
      if (is_here) result[{index, static_cast<std::int32_t>(face)}] = piece.fraction();
    }
  }
  return result;
}

void check_against_brute_force(const TriangleMesh& mesh, const VoxelLattice& lattice) {
  const auto expected = brute_force(mesh, lattice);
  const std::vector<VoxelPiece> pieces = clip_by_voxels(mesh, lattice);
  REQUIRE(pieces.size() == expected.size());
  auto entry = expected.begin();
  for (const VoxelPiece& piece : pieces) {
    const auto& [voxel, face] = entry->first;
    REQUIRE(piece.voxel == voxel);
    REQUIRE(piece.piece.face == face);
    // Not by a cross product of doubles, which loses the area of slivers.
    const double whole = RationalPolygon(corners(mesh, static_cast<std::size_t>(face))).area();
    // Corners are within 2^-44 of their barycentric places; the polygon has at most nine.
    const double exact = CGAL::to_double(entry->second) * whole;
    REQUIRE(piece.piece.area > 0.0);
    REQUIRE(std::abs(piece.piece.area - exact) <= 1e-12 * whole);
    REQUIRE(piece.piece.polygon.size() >= 3);
    const Eigen::Vector3i v = lattice.voxel(voxel);
    for (const Eigen::Vector3d& corner : piece.piece.polygon) {
      for (int axis = 0; axis < 3; ++axis) {
        const double slack = 1e-12 * (std::abs(corner[axis]) + lattice.voxel_size);
        REQUIRE(corner[axis] >= lattice.plane(axis, v[axis]) - slack);
        REQUIRE(corner[axis] <= lattice.plane(axis, v[axis] + 1) + slack);
      }
    }
    ++entry;
  }
}

// Loose triangles with corners drawn by `coordinate`.
template <typename Coordinate>
TriangleMesh loose_triangles(int count, const Coordinate& coordinate) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      const double x = coordinate();
      const double y = coordinate();
      const double z = coordinate();
      mesh.vertices.emplace_back(x, y, z);
    }
    mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

double sum_of_areas(const std::vector<SurfacePatch>& patches) {
  return std::accumulate(patches.begin(), patches.end(), 0.0,
                         [](double sum, const SurfacePatch& p) { return sum + p.area; });
}

}  // namespace

TEST_CASE("Pieces of triangles in general position are those of rational arithmetic",
          "[geometry][surface_patch]") {
  Random random(1);
  check_against_brute_force(loose_triangles(60, [&] { return random.uniform(0.0, 4.0); }),
                            unit_lattice(4));
}

TEST_CASE("Pieces of triangles with corners in voxel planes are those of rational arithmetic",
          "[geometry][surface_patch]") {
  // Halves: most corners lie in planes, edges and corners of voxels; some triangles are degenerate
  // or lie wholly in a plane.
  Random random(2);
  const auto half = [&] { return 0.5 * static_cast<double>(1 + random.index(6)); };
  check_against_brute_force(loose_triangles(150, half), unit_lattice(4));
}

TEST_CASE("Pieces a hair's breadth beside voxel planes are those of rational arithmetic",
          "[geometry][surface_patch]") {
  // One or two ulps beside a whole number: filters cannot decide, rationals must.
  Random random(3);
  const auto near = [&] {
    double x = static_cast<double>(1 + random.index(3));
    for (std::uint64_t ulps = random.index(3); ulps > 0; --ulps) {
      x = std::nextafter(x, random.index(2) == 0 ? 0.0 : 4.0);
    }
    return x;
  };
  check_against_brute_force(loose_triangles(100, near), unit_lattice(4));
}

TEST_CASE("Pieces of slivers of height 1e-12 are those of rational arithmetic",
          "[geometry][surface_patch]") {
  Random random(4);
  TriangleMesh mesh = loose_triangles(40, [&] { return random.uniform(0.5, 3.5); });
  for (const Face& f : mesh.faces) {
    const double t = random.uniform(0.2, 0.8);
    mesh.vertices[f[2]] = mesh.vertices[f[0]] + t * (mesh.vertices[f[1]] - mesh.vertices[f[0]]) +
                          Eigen::Vector3d::Constant(1e-12);
  }
  check_against_brute_force(mesh, unit_lattice(4));
}

TEST_CASE("Pieces near coordinate 1e6 are those of rational arithmetic",
          "[geometry][surface_patch]") {
  Random random(5);
  const VoxelLattice lattice{Eigen::Vector3d::Constant(1e6), 0.1, Eigen::Vector3i::Constant(4)};
  check_against_brute_force(loose_triangles(60, [&] { return 1e6 + random.uniform(0.0, 0.4); }),
                            lattice);
}

TEST_CASE("The face of a box that lies in a voxel plane belongs to the higher voxel",
          "[geometry][surface_patch]") {
  // The unit cube in the middle voxel of 3 x 3 x 3. Its low faces lie in planes 1, of which that
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
    // Coordinates of 0.07 rounded at 1e-17 against faces of 0.01: 1e-15 relative, a few hundred
    // pieces.
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
      // A voxel is an eighth of the diameter: the normal varies little about the radial direction.
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
  // In one voxel: a triangle of area 1/2 facing +z and one of area 1/8 facing +x.
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

TEST_CASE("Patches do not depend on the order of the faces", "[geometry][surface_patch]") {
  // Turned, since in a symmetric position two points of a patch can be equally near to its mean.
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

TEST_CASE("A mesh that leaves the lattice is refused", "[geometry][surface_patch]") {
  TriangleMesh cube = box({1.0, 1.0, 1.0});
  CHECK_THROWS_AS(surface_patches(cube, unit_lattice(3)), InvalidInput);
  for (auto& vertex : cube.vertices) vertex.array() += 2.5;  // High faces in the last plane.
  CHECK_THROWS_WITH(surface_patches(cube, unit_lattice(3)), Catch::Contains("leaves the lattice"));
  CHECK_NOTHROW(surface_patches(cube, unit_lattice(4)));
  CHECK_THROWS_AS(surface_patches(cube, VoxelLattice{}), InvalidInput);
}

TEST_CASE("A mesh without faces or of degenerate faces has no patches",
          "[geometry][surface_patch]") {
  TriangleMesh mesh;
  CHECK(surface_patches(mesh, unit_lattice(2)).empty());
  mesh.vertices = {{0.1, 0.1, 0.1}, {0.3, 0.3, 0.3}, {0.5, 0.5, 0.5}};
  mesh.faces = {{0, 1, 2}, {0, 0, 1}, {1, 1, 1}};
  CHECK(surface_patches(mesh, unit_lattice(2)).empty());
}
