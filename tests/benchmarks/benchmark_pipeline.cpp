// What it measures: every stage from a mesh file to grasps of the Barrett hand on the bunny
// (75 408 faces, longest extent 0.15 m, 30 voxels), on one thread.
//
// How to read it: one-off stages are the median of several runs; the stages of planning are totals
// over a fixed number of attempts, divided by the usable grasps found, failures counted. "share" is
// of that section's total. Run: build/unity/bin/graspfit_benchmarks "[pipeline]".
#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/geometry/mesh_repair.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/hands/hand_library.hpp"
#include "support/catch.hpp"
#include "support/skip.hpp"
#include "support/test_data.hpp"
#include "timing.hpp"

namespace {

using namespace graspfit;

using testing::median;
using testing::seconds_of;

using Rows = std::vector<std::pair<std::string, double>>;

void print_shares(const std::string& title, const Rows& rows) {
  double total = 0.0;
  for (const auto& [name, seconds] : rows) total += seconds;
  std::printf("\n%s\n", title.c_str());
  for (const auto& [name, seconds] : rows) {
    std::printf("  %-38s %9.2f ms  %5.1f %%\n", name.c_str(), seconds * 1e3,
                100.0 * seconds / total);
  }
  std::printf("  %-38s %9.2f ms\n", "sum", total * 1e3);
}

TEST_CASE("Pipeline from mesh file to grasps", "[!benchmark][pipeline]") {
  const auto file = testing::packaged_mesh("bunny00.off");
  if (!file)
    GRASPFIT_SKIP_TEST("bunny00.off of libcgal-demo is not unpacked; run ./quickstart once");
  constexpr int kRuns = 7;
  constexpr int kAttempts = 200;

  std::vector<double> read, analysis, query, patches, voxels, distance, scores;
  geometry::TriangleMesh mesh;
  grasp::PlannerOptions options;
  options.max_attempts = kAttempts;
  options.count = kAttempts;
  options.acceptance = grasp::Acceptance::Usable;
  options.search = grasp::SearchRule::First;
  const hands::HandModel hand = hands::find_hand("barrett");
  for (int run = 0; run < kRuns; ++run) {
    geometry::MeshFile read_file;
    read.push_back(seconds_of([&] { read_file = geometry::read_mesh(*file); }));
    mesh = geometry::scaled(read_file.mesh, 0.15 / geometry::longest_extent(read_file.mesh));
    analysis.push_back(seconds_of([&] { mesh = geometry::repair_mesh(mesh).mesh; }));
    const grasp::ObjectModelTimings timings = grasp::prepare_object(mesh, hand, options).timings;
    query.push_back(timings.query_s);
    patches.push_back(timings.patches_s);
    voxels.push_back(timings.voxels_s);
    distance.push_back(timings.distance_s);
    scores.push_back(timings.scores_s);
  }
  print_shares("Once per object (bunny00, 0.15 m, 30 voxels; median of 7)",
               {{"read", median(read)},
                {"analysis and repair", median(analysis)},
                {"box tree", median(query)},
                {"voxel classes", median(voxels)},
                {"surface patches", median(patches)},
                {"distance map (interaction volume)", median(distance)},
                {"score map", median(scores)}});

  const grasp::ObjectModel object = grasp::prepare_object(mesh, hand, options);
  const grasp::PlannerResult result =
      grasp::plan_grasps(object, hand, options, {}, {.num_threads = 1});
  const double usable = std::max<double>(1.0, static_cast<double>(result.statistics.usable()));
  const grasp::PlannerTimings& t = result.timings;
  print_shares("Per usable grasp (" + std::to_string(result.statistics.attempts) + " attempts, " +
                   std::to_string(result.statistics.usable()) + " usable, " +
                   std::to_string(result.statistics.valid()) + " valid)",
               {{"target selection", t.targets_s / usable},
                {"fitting, without contact tests", (t.fitting_s - t.contact_tests_s) / usable},
                {"contact estimation", t.contact_tests_s / usable},
                {"measure", t.measure_s / usable},
                {"refinement", t.refinement_s / usable},
                {"ways in and squeezes", t.pre_grasp_s / usable},
                {"rest", (t.total_s - t.targets_s - t.fitting_s - t.measure_s - t.refinement_s -
                          t.pre_grasp_s) /
                             usable}});
  CHECK(result.statistics.attempts == kAttempts);
}

}  // namespace
