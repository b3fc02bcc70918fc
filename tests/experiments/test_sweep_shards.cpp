#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <map>
#include <thread>

#include "counting_experiment.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/sweep/sweep_shards.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_sweep_shards {

using namespace graspfit::sweep;
using graspfit::base::InvalidInput;
using graspfit::base::read_file;
using graspfit::testing::counting_experiment;
using graspfit::testing::kCountingConfig;
using graspfit::testing::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

/// Returns the counting experiment, with a file and details of every cell, and without data for
/// step 2.
Experiment experiment_with_all() {
  Experiment experiment = counting_experiment();
  experiment.details = {{"part", "1", "of the seed"}};
  const std::vector<Column> summary = {{"parts", "1", "of all cells"}};
  experiment.run = [run = experiment.run, columns = experiment.details](const Cell& cell,
                                                                        const fs::path& folder) {
    if (cell.labels[1] == "2") throw MissingData("step2.off is not there");
    CellResult result = run(cell, folder);
    result.details.emplace_back(columns);
    result.details.back().set("part", static_cast<std::int64_t>(cell.seed % 7));
    fs::create_directories(folder);
    std::ofstream(folder / "cell.txt") << cell.key;
    return result;
  };
  const auto summed_up = [columns = summary](const ParameterSweep&,
                                             const std::vector<FinishedCell>& cells) {
    std::vector<ResultRow> all(1, ResultRow(columns));
    all[0].set("parts", static_cast<std::int64_t>(cells.size()));
    return all;
  };
  experiment.summaries.push_back({"summary", summary, summed_up});
  return experiment;
}

ExperimentConfig config_in(const TemporaryFolder& folder, const ConfigRequest& request = {}) {
  return read_config(counting_experiment(), folder.write("counting.json", kCountingConfig),
                     request);
}

/// Returns all results but timings and manifest, by name.
std::map<std::string, std::string> results_in(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const char* const ending : {".csv", ".details.csv", ".summary.csv"}) {
    files[ending] = read_file(folder / (std::string("counting") + ending));
  }
  for (const auto& entry : fs::recursive_directory_iterator(folder / "cells")) {
    if (entry.is_regular_file()) {
      files[entry.path().lexically_relative(folder).string()] = read_file(entry.path());
    }
  }
  return files;
}

void run_shards(const Experiment& experiment, const ExperimentConfig& config, const fs::path& out,
                std::size_t count) {
  for (std::size_t i = count; i >= 1; --i) {
    run_sweep(experiment, config, {}, {out, 1, Shard{i, count}});
  }
}

}  // namespace

TEST_CASE("Shards in any number merge to the bytes of one run", "[experiments][shards]") {
  const TemporaryFolder folder;
  const ExperimentConfig config = config_in(folder);
  const Experiment experiment = experiment_with_all();
  const RunProgress whole = run_sweep(experiment, config, {}, {folder.path() / "whole", 1});
  const auto expected = results_in(folder.path() / "whole");
  // Of 24 cells 6 are without data and 2 fail.
  REQUIRE(expected.size() == 3 + 16);
  for (const std::size_t count : {1, 2, 7, 24, 30}) {
    const fs::path out = folder.path() / std::to_string(count);
    run_shards(experiment, config, out, count);
    CHECK_FALSE(fs::exists(out / "counting.csv"));
    const RunProgress merged = merge_shards(experiment, config, {}, out);
    CHECK(results_in(out) == expected);
    CHECK(merged.num_cells == 24);
    CHECK(merged.num_done == whole.num_done);
    CHECK(merged.num_failed == whole.num_failed);
    CHECK(merged.num_skipped == 6);
    const auto manifest = nlohmann::json::parse(read_file(out / "counting.manifest.json"));
    CHECK(manifest.at("shards").size() == count);
    // The merge is repeated, and then done by a run that has nothing left to do but the cells
    // without data.
    merge_shards(experiment, config, {}, out);
    CHECK(run_sweep(experiment, config, {}, {out, 1}).num_resumed == 18);
    CHECK(results_in(out) == expected);
  }
}

TEST_CASE("Shards of several partitions and a run of its own merge, too", "[experiments][shards]") {
  const TemporaryFolder folder;
  const ExperimentConfig config = config_in(folder);
  const Experiment experiment = experiment_with_all();
  run_sweep(experiment, config, {}, {folder.path() / "whole", 1});
  const fs::path out = folder.path() / "mixed";
  run_shards(experiment, config, out, 2);
  fs::remove_all(shard_folder(out, {2, 2}));
  CHECK_THROWS_WITH(
      merge_shards(experiment, config, {}, out),
      graspfit::testing::Contains("12 of 24 cells are missing, letter=a step=0 seed=2 first"));
  CHECK_FALSE(fs::exists(out / "counting.csv"));
  for (const std::size_t i : {1, 2}) run_sweep(experiment, config, {}, {out, 2, Shard{i, 3}});
  run_sweep(experiment, config, {}, {out, 1, Shard{12, 12}});
  CHECK_THROWS_WITH(merge_shards(experiment, config, {}, out),
                    graspfit::testing::Contains("cells are missing"));
  run_sweep(experiment, config, {}, {out, 1});
  merge_shards(experiment, config, {}, out);
  CHECK(results_in(out) == results_in(folder.path() / "whole"));
}

TEST_CASE("A killed shard continues", "[experiments][shards]") {
  const TemporaryFolder folder;
  const ExperimentConfig config = config_in(folder);
  const Experiment experiment = experiment_with_all();
  run_sweep(experiment, config, {}, {folder.path() / "whole", 1});
  const fs::path out = folder.path() / "killed";
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    Experiment dying = experiment;
    dying.run = [&](const Cell& cell, const fs::path& cells) {
      if (cell.labels[0] == "b") ::raise(SIGKILL);
      return experiment.run(cell, cells);
    };
    run_sweep(dying, config, {}, {out, 1, Shard{1, 2}});
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));
  const std::vector<SweepStatus> killed = sweep_status("counting", out);
  REQUIRE(killed.size() == 2);
  CHECK(killed[1].name == "shard 1-of-2");
  CHECK(killed[1].num_cells == 12);
  CHECK(killed[1].num_done == 3);
  CHECK(killed[1].num_tried_again == 1);
  CHECK_FALSE(killed[1].is_running);
  CHECK(run_sweep(experiment, config, {}, {out, 1, Shard{1, 2}}).num_resumed == 3);
  run_sweep(experiment, config, {}, {out, 1, Shard{2, 2}});
  merge_shards(experiment, config, {}, out);
  CHECK(results_in(out) == results_in(folder.path() / "whole"));
}

TEST_CASE("A merge counts cells that failed for a reason that may pass", "[experiments][shards]") {
  const TemporaryFolder folder;
  const ExperimentConfig config = config_in(folder);
  Experiment crowded = counting_experiment();
  crowded.run = [run = crowded.run](const Cell& cell, const fs::path& cells) -> CellResult {
    if (cell.labels[0] == "a") throw graspfit::base::IoError("no space left");
    return run(cell, cells);
  };
  const fs::path out = folder.path() / "out";
  run_shards(crowded, config, out, 2);
  CHECK(merge_shards(crowded, config, {}, out).num_not_final == 8);
  CHECK_THROWS_WITH(require_publishable_manifest(out / "counting.manifest.json"),
                    graspfit::testing::Contains("8 cells failed for a reason that may pass"));
}

TEST_CASE("Shards that do not belong together are not merged", "[experiments][shards]") {
  const TemporaryFolder folder;
  const ExperimentConfig config = config_in(folder);
  const Experiment experiment = experiment_with_all();
  const fs::path out = folder.path() / "out";
  CHECK_THROWS_WITH(merge_shards(experiment, config, {}, out),
                    graspfit::testing::Contains("has no shards"));
  run_shards(experiment, config, out, 2);
  const ExperimentConfig other = config_in(folder, {false, {{"base", {"1"}}}});
  CHECK_THROWS_WITH(merge_shards(experiment, other, {}, out),
                    graspfit::testing::Contains("holds results of another configuration"));
  RunManifest rebuilt;
  rebuilt.program = "another";
  CHECK_THROWS_WITH(merge_shards(experiment, config, rebuilt, out),
                    graspfit::testing::Contains("holds results of another build"));

  Experiment different = experiment;
  different.run = [&](const Cell& cell, const fs::path& cells) {
    CellResult result = experiment.run(cell, cells);
    result.row.set("sum", -1.0);
    return result;
  };
  run_sweep(different, config, {}, {out, 1, Shard{3, 3}});
  CHECK_THROWS_WITH(merge_shards(experiment, config, {}, out),
                    graspfit::testing::Contains("have different results of cell letter="));
}

TEST_CASE("Shards of other inputs are not merged or continued", "[experiments][shards]") {
  const TemporaryFolder folder;
  const ExperimentConfig config = config_in(folder);
  const fs::path input = folder.write("mesh.off", "before");
  Experiment experiment = experiment_with_all();
  experiment.inputs = [input](const Cell&) { return std::vector{input}; };
  const fs::path out = folder.path() / "out";
  run_sweep(experiment, config, {}, {out, 1, Shard{1, 2}});
  folder.write("mesh.off", "after");
  CHECK_THROWS_WITH(run_sweep(experiment, config, {}, {out, 1, Shard{1, 2}}),
                    graspfit::testing::Contains("holds results of another") &&
                        graspfit::testing::Contains("mesh.off"));
  run_sweep(experiment, config, {}, {out, 1, Shard{2, 2}});
  CHECK_THROWS_WITH(merge_shards(experiment, config, {}, out),
                    graspfit::testing::Contains("mesh.off"));
  CHECK_FALSE(fs::exists(out / "counting.csv"));
}

TEST_CASE("Status counts each cell once and tells what runs", "[experiments][shards]") {
  const TemporaryFolder folder;
  const ExperimentConfig config = config_in(folder);
  const Experiment experiment = experiment_with_all();
  const fs::path out = folder.path() / "out";
  CHECK_THROWS_WITH(sweep_status("counting", out),
                    graspfit::testing::Contains("has no results of counting"));
  run_sweep(experiment, config, {}, {out, 1, Shard{1, 2}});
  run_sweep(experiment, config, {}, {out, 1, Shard{1, 3}});

  Experiment watched = experiment;
  std::vector<SweepStatus> during;
  watched.run = [&](const Cell& cell, const fs::path& cells) {
    during = sweep_status("counting", out);
    return experiment.run(cell, cells);
  };
  run_sweep(watched, config, {}, {out, 1, Shard{2, 3}});
  REQUIRE(during.size() == 4);
  CHECK(during[0].is_running);
  CHECK(during[3].is_running);
  CHECK_FALSE(during[1].is_running);
  CHECK(during[3].num_cells == 8);

  const std::vector<SweepStatus> after = sweep_status("counting", out);
  CHECK(after[0].name == "all");
  CHECK(after[0].num_cells == 24);
  // Of the cells 0 to 23 the even ones are done and those of 0 mod 3 and 1 mod 3: 12 + 4 + 4. Cells
  // of 6 and 7 mod 8 are without data, and 23 is not among those that are done.
  CHECK(after[0].num_done + after[0].num_tried_again == 20);
  CHECK(after[0].num_tried_again == 5);
  CHECK(after[0].num_failed == 2);  // They are 20 and 21.
  CHECK_FALSE(after[0].is_running);
}

TEST_CASE("A run that starts while its status is asked for is not refused",
          "[experiments][shards]") {
  const TemporaryFolder folder;
  const ExperimentConfig config = config_in(folder);
  const fs::path out = folder.path() / "out";
  run_sweep(counting_experiment(), config, {}, {out, 1});
  // Who asks for the status holds a shared lock for a moment; this one holds it for 0.1 s.
  const int descriptor = ::open((out / "counting.cells").c_str(), O_RDONLY | O_CLOEXEC);
  REQUIRE(descriptor >= 0);
  REQUIRE(::flock(descriptor, LOCK_SH | LOCK_NB) == 0);
  std::thread asking([descriptor] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ::close(descriptor);
  });
  std::string refusal;
  try {
    run_sweep(counting_experiment(), config, {}, {out, 1});
  } catch (const graspfit::base::IoError& error) {
    refusal = error.what();
  }
  asking.join();
  CHECK(refusal.empty());
}

TEST_CASE("A shard is written I/N", "[experiments][shards]") {
  CHECK(parse_shard("2/7").name() == "2-of-7");
  CHECK(Shard{2, 7}.num_cells(24) == 4);
  CHECK(Shard{3, 7}.num_cells(24) == 4);
  CHECK(Shard{4, 7}.num_cells(24) == 3);
  CHECK(Shard{7, 7}.num_cells(3) == 0);
  for (const char* const text :
       {"", "2", "/", "2/", "/7", "0/7", "8/7", "2/7x", "-1/7", "1/0", "2-7", "1/1000000"}) {
    CHECK_THROWS_AS(parse_shard(text), InvalidInput);
  }
}

}  // namespace test_sweep_shards
