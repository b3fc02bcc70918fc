// What it measures: cutting all of the bunny (75 408 faces) into the surface patches of its voxels,
// with area, centroids and normals, on one thread. It compares `surface_patches`, whose decisions
// are exact, with the same loop in plain doubles, with CGAL's exact constructions, and, for 50
// voxels, with clipping the mesh by CGAL. Then it measures how the time grows with the resolution.
//
// How to read it: times are processor times of the process, so that a busy machine matters little;
// they are medians of repetitions that take turns. Memory is that of the results only. All run on
// memory that the process already has (see keep_memory). Beside two ratios stand the bounds that
// they are to keep. Run: build/unity/bin/graspfit_benchmarks "[clipping]".
#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <numeric>
#include <vector>

#include "benchmarks/clipping_by_cgal.hpp"
#include "benchmarks/sutherland_hodgman_patches.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"
#include "support/test_data.hpp"

namespace {

using namespace graspfit;
using geometry::SurfacePatch;
using Patches = std::vector<SurfacePatch>;

struct DoubleArithmetic {
  using Point = Eigen::Vector3d;
  struct Plane {
    int axis;
    double coordinate;
  };

  static constexpr bool kMeasuresWholeFaces = false;

  static const Point& point(const Eigen::Vector3d& p) { return p; }
  static const Eigen::Vector3d& to_double(const Point& p) { return p; }
  static Plane plane(int axis, double coordinate) { return {axis, coordinate}; }
  static bool is_below(const Point& p, const Plane& plane) {
    return p[plane.axis] < plane.coordinate;
  }
  static Point meet(const Point& p, const Point& q, const Plane& plane) {
    const double t = (plane.coordinate - p[plane.axis]) / (q[plane.axis] - p[plane.axis]);
    return p + t * (q - p);
  }
  static void measure(const Point* polygon, int n, double& area, Eigen::Vector3d& centroid) {
    area = 0.0;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    Eigen::Vector3d p = polygon[1] - polygon[0];
    for (int i = 2; i < n; ++i) {
      const Eigen::Vector3d q = polygon[i] - polygon[0];
      const double part = 0.5 * p.cross(q).norm();
      area += part;
      moment += part * (p + q);
      p = q;
    }
    centroid = polygon[0] + moment / (3.0 * area);
  }
};

// Otherwise each run would, or would not, give its memory back to the system and get it anew, page
// by page, depending on the largest piece of memory asked for before.
void keep_memory() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // This is the most it takes.
  mallopt(M_TRIM_THRESHOLD, 2'000'000'000);
}

template <typename Work>
double seconds_of(const Work& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

double area_of(const Patches& patches) {
  return std::accumulate(patches.begin(), patches.end(), 0.0,
                         [](double sum, const SurfacePatch& patch) { return sum + patch.area; });
}

double megabytes_of(const Patches& patches) {
  std::size_t bytes = patches.capacity() * sizeof(SurfacePatch);
  for (const SurfacePatch& patch : patches) bytes += patch.faces.capacity() * sizeof(std::int32_t);
  return static_cast<double>(bytes) / 1e6;
}

TEST_CASE("Clipping a mesh into surface patches", "[!benchmark][clipping]") {
  const auto file = testing::packaged_mesh("bunny00.off");
  if (!file)
    GRASPFIT_SKIP_TEST("bunny00.off of libcgal-demo is not unpacked; run ./quickstart once");
  const geometry::TriangleMesh mesh = geometry::read_mesh(*file).mesh;
  const auto lattice_of = [&](int resolution) {
    return geometry::lattice_around(geometry::bounding_box(mesh), {.resolution = resolution});
  };
  keep_memory();

  const geometry::VoxelLattice lattice = lattice_of(30);
  constexpr int kRuns = 21;
  constexpr int kEpeckEvery = 4;
  std::vector<double> ours_s, doubles_s, epeck_s, frugal_s;
  Patches ours, doubles, epeck, frugal;
  for (int run = 0; run < kRuns; ++run) {
    ours_s.push_back(seconds_of([&] { ours = geometry::surface_patches(mesh, lattice); }));
    doubles_s.push_back(seconds_of([&] {
      doubles = testing::SutherlandHodgmanPatches<DoubleArithmetic>(mesh, lattice).run();
    }));
    if (run % kEpeckEvery == 0) {
      epeck_s.push_back(
          seconds_of([&] { epeck = testing::surface_patches_by_epeck(mesh, lattice); }));
      frugal_s.push_back(
          seconds_of([&] { frugal = testing::surface_patches_by_frugal_epeck(mesh, lattice); }));
    }
  }
  // In general position all find the same patches, as far as doubles can tell of the smallest.
  REQUIRE(doubles.size() == ours.size());
  REQUIRE(epeck.size() == ours.size());
  REQUIRE(frugal.size() == ours.size());
  const double face = lattice.voxel_size * lattice.voxel_size;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    REQUIRE(doubles[i].voxel == ours[i].voxel);
    REQUIRE(epeck[i].voxel == ours[i].voxel);
    REQUIRE(doubles[i].area == Approx(ours[i].area).margin(1e-10 * face));
    REQUIRE(frugal[i].area == Approx(ours[i].area).margin(1e-10 * face));
    REQUIRE(epeck[i].area == Approx(ours[i].area).margin(1e-10 * face));
    if (ours[i].area < 1e-6 * face) continue;
    REQUIRE((doubles[i].centroid - ours[i].centroid).norm() < 1e-6 * lattice.voxel_size);
    REQUIRE((epeck[i].centroid - ours[i].centroid).norm() < 1e-6 * lattice.voxel_size);
  }

  std::vector<std::int64_t> voxels;
  std::vector<double> areas;
  for (std::size_t i = 0; i < 50; ++i) {
    const SurfacePatch& patch = ours[i * ours.size() / 50];
    voxels.push_back(patch.voxel);
    areas.push_back(patch.area);
  }
  std::vector<double> cgal_s;
  const auto clipped = testing::clip_by_cgal(mesh, lattice, voxels);
  for (std::size_t i = 0; i < clipped.size(); ++i) {
    cgal_s.push_back(clipped[i].seconds);
    REQUIRE(clipped[i].area == Approx(areas[i]).epsilon(1e-6));
  }

  const double base = median(ours_s);
  std::printf("\nbunny00, 30 voxels: %zu faces, %zu patches (medians, one thread)\n",
              mesh.faces.size(), ours.size());
  std::printf("  %-44s %9.2f ms\n", "surface_patches, decisions exact", base * 1e3);
  std::printf("  %-44s %9.2f ms  ours / this  %5.2f  (at most 1.5)\n",
              "the same loop in plain doubles", median(doubles_s) * 1e3, base / median(doubles_s));
  std::printf("  %-44s %9.2f ms  this / ours  %5.1f  (at least 10)\n",
              "the same loop in CGAL's Epeck", median(epeck_s) * 1e3, median(epeck_s) / base);
  std::printf("  %-44s %9.2f ms  this / ours  %5.1f\n", "Epeck where cut, as frugal as it can be",
              median(frugal_s) * 1e3, median(frugal_s) / base);
  const double per_patch = base / static_cast<double>(ours.size());
  std::printf("  %-44s %9.2f ms  this / ours  %5.0f\n", "CGAL clip, per voxel (50 sampled)",
              median(cgal_s) * 1e3, median(cgal_s) / per_patch);
  std::printf("  %-44s %9.5f ms\n", "surface_patches, per patch", per_patch * 1e3);

  std::printf("\n  voxels       time   patches    result   per patch\n");
  double previous = 0.0;
  for (const int resolution : {30, 64, 128, 256}) {
    const geometry::VoxelLattice finer = lattice_of(resolution);
    std::vector<double> seconds;
    Patches patches;
    for (int run = 0; run < 7; ++run) {
      seconds.push_back(seconds_of([&] { patches = geometry::surface_patches(mesh, finer); }));
    }
    CHECK(area_of(patches) == Approx(area_of(ours)).epsilon(1e-10));
    const double time = median(seconds);
    std::printf("  %6d %7.1f ms  %8zu %6.1f MB  %6.2f us", resolution, time * 1e3, patches.size(),
                megabytes_of(patches), time * 1e6 / static_cast<double>(patches.size()));
    if (previous > 0.0) std::printf("   %4.2f x the one before", time / previous);
    std::printf("%s\n", resolution == 256 ? "  (at most 4.5)" : "");
    previous = time;
  }
}

}  // namespace
