// What it measures: one core's time per valid grasp on the bunny (75 408 faces), failures counted,
// until the first 100 valid ones of one seed are found, with the Barrett hand (0.15 m, three
// fingers) and the human hand (three fingers). It also measures the share of each stage, and the
// ratio to building CGAL's AABB tree on the same mesh in the same run.
//
// How to read it: "with the object's model" adds a hundredth of its cost (without reading the file,
// and without the offline search for weak features, which is kept in the user's cache). Run:
// build/unity/bin/graspfit_benchmarks "[planner]".
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
#include "tree_by_cgal.hpp"

namespace {

using namespace graspfit;

constexpr int kGrasps = 100;

void plan_hundred(const geometry::TriangleMesh& mesh, const std::string& hand_name, double tree_s) {
  const hands::HandModel hand = hands::find_hand(hand_name);
  grasp::PlannerOptions options;
  options.count = kGrasps;
  options.max_attempts = 5000;
  options.search = grasp::SearchRule::First;
  options.distinct = {0.0, 0.0, 0.0};
  grasp::prepare_object(mesh, hand, options);  // From here on weak features come from the cache.
  const grasp::ObjectModel object = grasp::prepare_object(mesh, hand, options);
  const grasp::ObjectModelTimings& model = object.timings;
  const grasp::PlannerResult result =
      grasp::plan_grasps(object, hand, options, {}, {.num_threads = 1});
  REQUIRE(result.grasps.size() == kGrasps);
  const grasp::PlannerTimings& t = result.timings;
  const double per_grasp_s = t.total_s / kGrasps;
  const double model_s =
      model.query_s + model.patches_s + model.voxels_s + model.distance_s + model.scores_s;
  const double with_model_s = per_grasp_s + model_s / kGrasps;
  std::printf("\n%s on the bunny: %lld attempts for %d valid grasps, one core\n", hand_name.c_str(),
              static_cast<long long>(result.statistics.attempts), kGrasps);
  const double rest_s =
      t.total_s - t.targets_s - t.fitting_s - t.refinement_s - t.measure_s - t.pre_grasp_s;
  for (const auto& [name, seconds] :
       std::vector<std::pair<std::string, double>>{{"target selection", t.targets_s},
                                                   {"fitting", t.fitting_s},
                                                   {"refinement", t.refinement_s},
                                                   {"contacts, measures, exact tests", t.measure_s},
                                                   {"ways in and squeezes", t.pre_grasp_s},
                                                   {"rest", rest_s}}) {
    std::printf("  %-34s %8.2f ms  %5.1f %%\n", name.c_str(), seconds / kGrasps * 1e3,
                100.0 * seconds / t.total_s);
  }
  std::printf("  %-34s %8.2f ms  %5.2f x CGAL's tree\n", "per valid grasp", per_grasp_s * 1e3,
              per_grasp_s / tree_s);
  std::printf("  %-34s %8.2f ms  %5.2f x CGAL's tree (model %.1f ms)\n", "with the object's model",
              with_model_s * 1e3, with_model_s / tree_s, model_s * 1e3);
}

TEST_CASE("Time per valid grasp", "[!benchmark][planner]") {
  const auto file = testing::packaged_mesh("bunny00.off");
  if (!file)
    GRASPFIT_SKIP_TEST("bunny00.off of libcgal-demo is not unpacked; run ./quickstart once");
  const geometry::TriangleMesh as_read = geometry::read_mesh(*file).mesh;
  const geometry::TriangleMesh mesh =
      geometry::repair_mesh(geometry::scaled(as_read, 0.15 / geometry::longest_extent(as_read)))
          .mesh;
  std::vector<double> trees;
  for (int run = 0; run < 7; ++run) trees.push_back(testing::seconds_of_cgal_tree(mesh));
  const double tree_s = testing::median(trees);
  std::printf("\nCGAL's AABB tree with distance acceleration: %.1f ms (median of 7)\n",
              tree_s * 1e3);
  for (const char* hand : {"barrett", "human_hand"}) plan_hundred(mesh, hand, tree_s);
}

}  // namespace
