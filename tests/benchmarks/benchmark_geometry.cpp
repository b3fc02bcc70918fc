// What it measures, on the bunny (75 408 faces):
//   1. mesh -> dense signed distance map, step by step, beside OpenVDB's narrow band (a smaller
//      answer) on the same lattice with a margin of 8 voxels on every side; and how time and memory
//      grow;
//   2. the same for the interaction box of a Barrett hand around an object of 0.15 m;
//   3. mesh file -> score map at 30 voxels.
//
// How to read it: times are wall times, medians of repetitions that are interleaved, so that
// whatever else the machine does hits both sides. Ours uses one thread; OpenVDB's are named.
// "ratio" is ours over OpenVDB's: below 1 is faster. Memory is the process's growth to its peak
// within a step. Run: build/unity/bin/graspfit_benchmarks "[geometry]".
#include <malloc.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/geometry/distance_map.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/mesh_repair.hpp"
#include "graspfit/geometry/surface_patch.hpp"
#include "graspfit/grasp/contact_score_map.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "support/catch.hpp"
#include "support/openvdb_field.hpp"
#include "support/skip.hpp"
#include "support/test_data.hpp"
#include "timing.hpp"

namespace {

using namespace graspfit;
using geometry::VoxelLattice;
using testing::median;
using testing::seconds_of;

constexpr double kMilli = 1e3;
constexpr double kMegabyte = 0x1p20;

// Returns a field of /proc/self/status in bytes.
double process_bytes(const std::string& field) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(field + ":")) return 1024.0 * std::stod(line.substr(field.size() + 1));
  }
  return 0.0;
}

// Returns how far the process's memory grows while `work` runs; what it frees before its end
// counts.
double peak_bytes_of(const std::function<void()>& work) {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";  // The peak starts anew.
  const double before = process_bytes("VmRSS");
  work();
  return process_bytes("VmHWM") - before;
}

struct Step {
  std::string name;
  std::vector<double> seconds;
  double bytes = 0.0;
};

// Makes the query with its tree, which the first question builds: whether a point is in the mesh
// that is plainly not.
void build_tree(std::optional<geometry::MeshQuery>& query, const geometry::TriangleMesh& mesh) {
  query.emplace(mesh);
  query->containment(query->box().min() - Eigen::Vector3d::Ones());
}

// The steps from a mesh to its distance map, whose results are all kept from step to step.
struct DistanceMapSteps {
  std::array<Step, 4> steps = {Step{"tree", {}, 0}, Step{"surface patches", {}, 0},
                               Step{"voxel classes", {}, 0}, Step{"distance map", {}, 0}};

  // `measured` runs a step and returns its cost.
  template <typename Use>
  void run(const geometry::TriangleMesh& mesh, const VoxelLattice& lattice, const Use& measured) {
    std::optional<geometry::MeshQuery> query;
    std::vector<geometry::SurfacePatch> patches;
    geometry::VoxelGrid grid;
    geometry::SignedDistanceMap map;
    measured(steps[0], [&] { build_tree(query, mesh); });
    measured(steps[1], [&] { patches = geometry::surface_patches(mesh, lattice); });
    measured(steps[2], [&] { grid = geometry::voxelize(*query, lattice, patches); });
    measured(steps[3], [&] { map = geometry::signed_distance_map(grid); });
  }
  void time(const geometry::TriangleMesh& mesh, const VoxelLattice& lattice) {
    run(mesh, lattice, [](Step& step, const std::function<void()>& work) {
      step.seconds.push_back(seconds_of(work));
    });
  }
  void weigh(const geometry::TriangleMesh& mesh, const VoxelLattice& lattice) {
    run(mesh, lattice,
        [](Step& step, const std::function<void()>& work) { step.bytes = peak_bytes_of(work); });
  }
  double total() const {
    std::vector<double> sums(steps[0].seconds.size(), 0.0);
    for (const Step& step : steps) {
      for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += step.seconds[i];
    }
    return median(sums);
  }
};

struct Comparison {
  DistanceMapSteps ours;
  std::array<std::vector<double>, 2> theirs;  // The first are with one thread, the second with two.
  std::size_t their_bytes = 0;
};

Comparison compare(const geometry::TriangleMesh& mesh, const VoxelLattice& lattice, int runs) {
  Comparison result;
  const testing::OpenVdbMesh other(mesh, lattice);
  for (int run = 0; run < runs; ++run) {
    result.ours.time(mesh, lattice);
    for (int threads : {1, 2}) {
      const testing::OpenVdbThreads limit(threads);
      result.theirs[threads - 1].push_back(
          seconds_of([&] { result.their_bytes = other.signed_distance_field().num_bytes(); }));
    }
  }
  result.ours.weigh(mesh, lattice);
  return result;
}

void print_heading(const char* title) {
  std::printf("\n%s\n  %-18s %10s %10s %10s %10s %10s | %10s %6s | %10s %6s\n", title, "lattice",
              "tree", "patches", "classes", "map", "sum", "OpenVDB 1", "ratio", "OpenVDB 2",
              "ratio");
}

void print_row(const VoxelLattice& lattice, const Comparison& result) {
  std::printf("  %4d x %4d x %4d", lattice.counts[0], lattice.counts[1], lattice.counts[2]);
  for (const Step& step : result.ours.steps) {
    std::printf(" %7.1f ms", median(step.seconds) * kMilli);
  }
  const double total = result.ours.total();
  std::printf(" %7.1f ms", total * kMilli);
  for (const std::vector<double>& seconds : result.theirs) {
    std::printf(" | %7.1f ms %6.2f", median(seconds) * kMilli, total / median(seconds));
  }
  std::printf("\n");
}

// Returns a lattice with `resolution` voxels along the longest extent and 8 more on every side.
VoxelLattice grown_lattice(const geometry::TriangleMesh& mesh, int resolution) {
  const double voxel_size = geometry::longest_extent(mesh) / resolution;
  return geometry::lattice_around(geometry::bounding_box(mesh),
                                  {.resolution = resolution, .margin = 7.5 * voxel_size});
}

TEST_CASE("Distance maps beside OpenVDB's narrow band", "[!benchmark][geometry]") {
  const auto file = testing::packaged_mesh("bunny00.off");
  if (!file)
    GRASPFIT_SKIP_TEST("bunny00.off of libcgal-demo is not unpacked; run ./quickstart once");
  const geometry::TriangleMesh read = geometry::read_mesh(*file).mesh;
  const geometry::TriangleMesh mesh = geometry::scaled(read, 0.15 / geometry::longest_extent(read));

  print_heading("Mesh to signed distance map, 8 voxels of room (ours: one thread)");
  constexpr std::array<std::pair<int, int>, 4> kRuns = {{{30, 9}, {64, 9}, {128, 7}, {256, 5}}};
  std::vector<Comparison> all;
  for (const auto& [resolution, runs] : kRuns) {
    const VoxelLattice lattice = grown_lattice(mesh, resolution);
    all.push_back(compare(mesh, lattice, runs));
    print_row(lattice, all.back());
  }

  std::printf(
      "\nGrowth: exponent of the resolution, time and peak memory\n  %-18s %21s %21s %12s\n",
      "step", "64 -> 128", "128 -> 256", "MB at 256");
  for (std::size_t s = 0; s < all[0].ours.steps.size(); ++s) {
    std::printf("  %-18s", all[0].ours.steps[s].name.c_str());
    for (std::size_t i = 1; i + 1 < all.size(); ++i) {
      const Step& coarse = all[i].ours.steps[s];
      const Step& fine = all[i + 1].ours.steps[s];
      std::printf(" %9.2f %9.2f  ", std::log2(median(fine.seconds) / median(coarse.seconds)),
                  std::log2(std::max(1.0, fine.bytes) / std::max(1.0, coarse.bytes)));
    }
    std::printf(" %11.1f\n", all.back().ours.steps[s].bytes / kMegabyte);
  }
  const double patches_growth =
      median(all[3].ours.steps[1].seconds) / median(all[2].ours.steps[1].seconds);
  std::printf("  patches at 256 take %.2f x those at 128; OpenVDB's field at 256 is %.1f MB\n",
              patches_growth, static_cast<double>(all[3].their_bytes) / kMegabyte);

  print_heading("Interaction box of a Barrett hand, object of 0.15 m (ours: one thread)");
  for (int resolution : {30, 64}) {
    const VoxelLattice lattice = geometry::lattice_around(
        geometry::bounding_box(mesh),
        {.resolution = resolution, .margin = hands::largest_reach(hands::find_hand("barrett"))});
    print_row(lattice, compare(mesh, lattice, 5));
  }
  CHECK(all.size() == kRuns.size());
}

TEST_CASE("From mesh file to score map", "[!benchmark][geometry]") {
  const auto file = testing::packaged_mesh("bunny00.off");
  if (!file)
    GRASPFIT_SKIP_TEST("bunny00.off of libcgal-demo is not unpacked; run ./quickstart once");
  std::array<Step, 7> steps = {Step{"read", {}, 0},
                               Step{"analysis and repair", {}, 0},
                               Step{"surface patches", {}, 0},
                               Step{"score map", {}, 0},
                               Step{"tree", {}, 0},
                               Step{"voxel classes", {}, 0},
                               Step{"distance map", {}, 0}};
  constexpr int kRuns = 15;
  std::size_t num_scores = 0;
  for (int run = 0; run < kRuns; ++run) {
    const auto timed = [&](int step, const std::function<void()>& work) {
      steps[step].seconds.push_back(seconds_of(work));
    };
    geometry::TriangleMesh mesh;
    std::optional<geometry::MeshQuery> query;
    std::vector<geometry::SurfacePatch> patches;
    geometry::VoxelGrid grid;
    timed(0, [&] { mesh = geometry::read_mesh(*file).mesh; });
    mesh = geometry::scaled(mesh, 0.15 / geometry::longest_extent(mesh));
    timed(1, [&] { mesh = geometry::repair_mesh(mesh).mesh; });
    const VoxelLattice lattice =
        geometry::lattice_around(geometry::bounding_box(mesh), {.resolution = 30});
    timed(2, [&] { patches = geometry::surface_patches(mesh, lattice); });
    timed(3, [&] { num_scores = grasp::contact_score_map(patches, lattice).scores.size(); });
    timed(4, [&] { build_tree(query, mesh); });
    timed(5, [&] { grid = geometry::voxelize(*query, lattice, patches); });
    timed(6, [&] { geometry::signed_distance_map(grid); });
  }
  // The score map needs only the first four steps.
  const auto sum = [&](int first, int last) {
    std::vector<double> sums(kRuns, 0.0);
    for (int run = 0; run < kRuns; ++run) {
      for (int step = first; step <= last; ++step) sums[run] += steps[step].seconds[run];
    }
    return median(sums) * kMilli;
  };
  std::printf("\nFile to score map (bunny00, 30 voxels, one thread; median of %d)\n", kRuns);
  for (const Step& step : steps) {
    std::printf("  %-38s %7.1f ms\n", step.name.c_str(), median(step.seconds) * kMilli);
  }
  std::printf("  %-38s %7.1f ms\n  %-38s %7.1f ms\n  %-38s %7.1f ms\n",
              "score map, reading excluded", sum(1, 3), "score map, reading included", sum(0, 3),
              "with tree, classes and distances", sum(0, 6));
  CHECK(num_scores > 0);
}

}  // namespace
