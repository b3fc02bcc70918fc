// What it measures: the wall time of a sweep of the planner (a torus in 36 cells with the Barrett
// hand, of nearly equal work) with one job and with two, each five times, in turns; the median
// ratio. With fewer cells the last one, during which the other job idles, weighs more.
//
// How to read it: cells share nothing but the journal, so two cores that are otherwise idle finish
// at least 1.8 times as fast as one. On a busy machine, or with cores that are two threads of one,
// it says less.
// Run: build/unity/bin/graspfit_benchmarks "[sweep]".
#include <cstdio>
#include <filesystem>
#include <thread>

#include "graspfit/experiments/experiment_registry.hpp"
#include "graspfit/sweep/sweep_runner.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"
#include "timing.hpp"

using namespace graspfit;

TEST_CASE("Two jobs against one", "[!benchmark][sweep]") {
  const testing::TemporaryFolder folder;
  const sweep::Experiment& experiment = experiments::find_experiment("parameter_sweeps");
  const auto file = folder.write("parameter_sweeps.json", R"({
    "experiment": "parameter_sweeps", "question": "-", "cell": "-", "seed": 1, "seeds": 36,
    "settings": {"hand": "barrett", "contacts": 3, "shape": "torus", "count": 12,
                 "max-attempts": 12, "weak-thickness-mm": 0, "parameter": "resolution"},
    "axes": {"resolution": [30]}
  })");
  const sweep::ExperimentConfig config = sweep::read_config(experiment, file);
  int run = 0;
  const auto seconds = [&](int jobs) {
    const auto out = folder.path() / std::to_string(run++);
    return testing::seconds_of([&] { sweep::run_sweep(experiment, config, {}, {out, jobs}); });
  };
  seconds(1);  // It fills the cache.
  std::vector<double> ratios;
  for (int i = 0; i < 5; ++i) {
    const double one = seconds(1);
    const double two = seconds(2);
    ratios.push_back(one / two);
    std::printf("one job %6.2f s, two jobs %6.2f s: %.2f times as fast\n", one, two, one / two);
  }
  std::printf("median %.2f on %u processors\n", testing::median(ratios),
              std::thread::hardware_concurrency());
}
