#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <system_error>
#include <thread>

#include "counting_experiment.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/sweep/sweep_runner.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_sweep_endurance {

using namespace graspfit::sweep;
using graspfit::base::read_file;
using graspfit::testing::counting_experiment;
using graspfit::testing::kCountingConfig;
using graspfit::testing::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

/// Returns the counting experiment with that many seeds, of 12 cells each.
ExperimentConfig config_with(const TemporaryFolder& folder, int num_seeds) {
  std::string text = kCountingConfig;
  const std::string seeds = "\"seeds\": 2";
  text.replace(text.find(seeds), seeds.size(), "\"seeds\": " + std::to_string(num_seeds));
  return read_config(counting_experiment(), folder.write("counting.json", text));
}

/// Runs `work` in a process of its own and returns it.
template <class Work>
pid_t start(const Work& work) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child != 0) return child;
  try {
    work();
  } catch (...) {
    ::_exit(1);
  }
  ::_exit(0);
}

}  // namespace

TEST_CASE("After 20 kills at random moments a sweep of 204 cells ends in the same bytes",
          "[experiments][sweep_runner]") {
  const TemporaryFolder folder;
  const ExperimentConfig config = config_with(folder, 17);
  REQUIRE(config.sweep.num_cells() == 204);
  run_sweep(counting_experiment(), config, {}, {folder.path() / "undisturbed", 1});

  const fs::path begun = folder.path() / "begun";  // It has a byte for every cell of a run.
  Experiment slow = counting_experiment();
  slow.run = [run = slow.run, begun](const Cell& cell, const fs::path& cells) {
    std::ofstream(begun, std::ios::app) << '.';
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return run(cell, cells);
  };
  const auto num_begun = [&] {
    std::error_code none;
    const auto size = fs::file_size(begun, none);
    return none ? 0 : static_cast<int>(size);
  };
  // The moments range from the very beginning of a run to well within it: every second one comes
  // after a cell that has ended, however slow the machine is. Another seed is another test.
  std::mt19937_64 random(20181012);
  const fs::path out = folder.path() / "killed";
  int num_killed = 0;
  for (int i = 0; num_killed < 20; ++i) {
    REQUIRE(i < 200);
    const auto moment = std::chrono::microseconds(random() % 80000);
    const int jobs = 1 + static_cast<int>(random() % 3);
    fs::remove(begun);
    const pid_t child = start([&] { run_sweep(slow, config, {}, {out, jobs}); });
    // More cells than there are jobs begin only after one has ended.
    for (int wait = 0; i % 2 == 1 && wait < 60000 && num_begun() <= jobs; ++wait) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::this_thread::sleep_for(moment);
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (WIFSIGNALED(status)) ++num_killed;
  }
  CHECK_FALSE(fs::exists(out / "counting.csv"));  // No run has come to its end.
  const RunProgress done = run_sweep(counting_experiment(), config, {}, {out, 2});
  CHECK(done.num_resumed > 0);
  CHECK(done.num_resumed < 204);
  CHECK(read_file(out / "counting.csv") == read_file(folder.path() / "undisturbed/counting.csv"));
}

TEST_CASE("Memory is flat over 10 000 cells", "[experiments][sweep_runner][full]") {
#if defined(__SANITIZE_ADDRESS__)
  SUCCEED("a sanitizer keeps freed memory");
#else
  const TemporaryFolder folder;
  // Every row has texts of 2 kB: 20 MB altogether, of which a run must not keep much.
  Experiment wordy = counting_experiment();
  wordy.run = [run = wordy.run](const Cell& cell, const fs::path& cells) {
    CellResult result = run(cell, cells);
    result.row.set("text", std::string(2000, 'x'));
    return result;
  };
  const auto peak_kb = [&](int num_seeds) {
    const ExperimentConfig config = config_with(folder, num_seeds);
    const fs::path out = folder.path() / std::to_string(num_seeds);
    const pid_t child = start([&] { run_sweep(wordy, config, {}, {out, 1}); });
    int status = 0;
    rusage usage{};
    ::wait4(child, &status, 0, &usage);
    REQUIRE(WIFEXITED(status));
    REQUIRE(WEXITSTATUS(status) == 0);
    CHECK(fs::file_size(out / "counting.csv") > 2000u * 11u * static_cast<unsigned>(num_seeds));
    return usage.ru_maxrss;
  };
  const long few = peak_kb(84);    // It has 1 008 cells.
  const long many = peak_kb(834);  // It has 10 008 cells.
  INFO("peak of 1 008 cells " << few << " kB, of 10 008 cells " << many << " kB");
  CHECK(many - few < 4000);
#endif
}

}  // namespace test_sweep_endurance
