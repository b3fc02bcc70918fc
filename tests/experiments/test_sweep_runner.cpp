#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <map>
#include <new>
#include <sstream>
#include <thread>

#include "counting_experiment.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/sha256.hpp"
#include "graspfit/sweep/data_files.hpp"
#include "graspfit/sweep/sweep_runner.hpp"
#include "graspfit/sweep/sweep_shards.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_sweep_runner {

using namespace graspfit::sweep;
using graspfit::base::read_file;
using graspfit::testing::counting_experiment;
using graspfit::testing::kCountingConfig;
using graspfit::testing::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

ExperimentConfig config_in(const TemporaryFolder& folder, const ConfigRequest& request = {}) {
  return read_config(counting_experiment(), folder.write("counting.json", kCountingConfig),
                     request);
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::istringstream stream(read_file(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Returns the table of a run that nothing disturbs.
std::string undisturbed_table(const TemporaryFolder& folder) {
  const fs::path out = folder.path() / "undisturbed";
  run_sweep(counting_experiment(), config_in(folder), {}, {out, 1});
  return read_file(out / "counting.csv");
}

/// Returns the experiment with cells that take a while, so that a kill comes in the middle.
Experiment slow_experiment() {
  Experiment experiment = counting_experiment();
  const auto run = experiment.run;
  experiment.run = [run](const Cell& cell, const fs::path& folder) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return run(cell, folder);
  };
  return experiment;
}

std::size_t num_lines(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error) ? lines_of(file).size() : 0;
}

/// Runs the slow experiment in a process of its own and kills it once it has finished cells.
void run_and_kill(const ExperimentConfig& config, const fs::path& out, std::size_t at_line) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    try {
      run_sweep(slow_experiment(), config, {}, {out, 1});
    } catch (...) {
      ::_exit(1);
    }
    ::_exit(0);
  }
  while (num_lines(out / "counting.cells") < at_line) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    REQUIRE(::waitpid(child, nullptr, WNOHANG) == 0);
  }
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));
}

}  // namespace

TEST_CASE("A sweep writes one row per cell in sweep order, failures with their reason",
          "[experiments][sweep_runner]") {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "results";
  RunManifest manifest;
  manifest.command = "graspfit experiment run counting";
  const RunProgress done = run_sweep(counting_experiment(), config_in(folder), manifest, {out, 1});
  CHECK(done.num_cells == 24);
  CHECK(done.num_done == 24);
  CHECK(done.num_failed == 2);
  CHECK(done.num_skipped == 0);

  const std::vector<std::string> rows = lines_of(out / "counting.csv");
  REQUIRE(rows.size() == 25);
  CHECK(rows[0] == "letter,step,seed,cell_seed,status,reason,sum,digits,text");
  CHECK(rows[1] == "a,0,1,5805151507310987,ok,,101,987,\"one, two\"");
  CHECK(rows[3].rfind("a,0.5,1,", 0) == 0);
  CHECK(rows[21].find(",failed,\"no sum for \"\"c\"\", says the test\",,,") != std::string::npos);
  CHECK(lines_of(out / "counting.timing.csv")[0] == "letter,step,seed,wall_s,cpu_s,nothing_s");

  const auto json = nlohmann::json::parse(read_file(out / "counting.manifest.json"));
  CHECK(json.at("command") == manifest.command);
  CHECK(json.at("seed") == 7);
  CHECK(json.at("cells").at("failed") == 2);
  CHECK(json.at("config").at("is_quick") == false);
  CHECK(json.at("config").at("as_run").at("axes").size() == 3);
}

TEST_CASE("One job and several write the same bytes", "[experiments][sweep_runner]") {
  const TemporaryFolder folder;
  const std::string expected = undisturbed_table(folder);
  for (const int jobs : {2, 7}) {
    const fs::path out = folder.path() / std::to_string(jobs);
    run_sweep(counting_experiment(), config_in(folder), {}, {out, jobs});
    CHECK(read_file(out / "counting.csv") == expected);
  }
}

TEST_CASE("Details and summary are the same bytes for any number of jobs and any interruption",
          "[experiments][sweep_runner]") {
  const TemporaryFolder folder;
  Experiment experiment = counting_experiment();
  experiment.details = {{"part", "1", "of the sum"}, {"note", "", "with a comma"}};
  const std::vector<Column> summary = {{"cells", "1", "finished"}, {"parts", "1", "of all cells"}};
  experiment.run = [run = experiment.run, details = experiment.details](const Cell& cell,
                                                                        const fs::path& cells) {
    if (cell.labels[0] == "b") throw MissingData("b.off is not there");
    CellResult result = run(cell, cells);
    for (std::int64_t part = 0; part < static_cast<std::int64_t>(cell.seed % 3); ++part) {
      result.details.emplace_back(details);
      result.details.back().set("part", part);
      result.details.back().set("note", "a, b");
    }
    return result;
  };
  const auto summed_up = [columns = summary](const ParameterSweep&,
                                             const std::vector<FinishedCell>& cells) {
    std::size_t parts = 0;
    for (const FinishedCell& cell : cells) parts += cell.details.size();
    std::vector<ResultRow> all(1, ResultRow(columns));
    all[0].set("cells", static_cast<std::int64_t>(cells.size()));
    all[0].set("parts", static_cast<std::int64_t>(parts));
    return all;
  };
  experiment.summaries.push_back({"summary", summary, summed_up});
  const ExperimentConfig config = config_in(folder);
  const auto tables_of = [&](int jobs, const std::string& name) {
    const fs::path out = folder.path() / name;
    run_sweep(experiment, config, {}, {out, jobs});
    return read_file(out / "counting.details.csv") + read_file(out / "counting.summary.csv");
  };
  const std::string expected = tables_of(1, "one");
  CHECK(tables_of(1, "one") == expected);  // All of it comes from disk.
  CHECK(tables_of(7, "seven") == expected);
  const std::vector<std::string> rows = lines_of(folder.path() / "one/counting.details.csv");
  REQUIRE(rows.size() > 2);
  CHECK(rows[0] == "letter,step,seed,part,note");
  CHECK_THAT(rows[1], graspfit::testing::EndsWith(",0,\"a, b\""));
  // Of 24 cells 8 are skipped and 2 fail.
  CHECK(lines_of(folder.path() / "one/counting.summary.csv") ==
        std::vector<std::string>{"cells,parts", "14," + std::to_string(rows.size() - 1)});
}

TEST_CASE("A sweep killed again and again ends in the same bytes and repeats no finished cell",
          "[experiments][sweep_runner]") {
  const TemporaryFolder folder;
  const std::string expected = undisturbed_table(folder);
  const ExperimentConfig config = config_in(folder);
  const fs::path out = folder.path() / "killed";
  for (const std::size_t at_line : {4, 10, 18}) {
    run_and_kill(config, out, at_line);
    CHECK_FALSE(fs::exists(out / "counting.csv"));
  }
  int num_run = 0;
  Experiment counted = counting_experiment();
  counted.run = [&num_run, run = counted.run](const Cell& cell, const fs::path& cells) {
    ++num_run;
    return run(cell, cells);
  };
  const RunProgress done = run_sweep(counted, config, {}, {out, 1});
  CHECK(done.num_resumed >= 14);
  CHECK(num_run == static_cast<int>(24 - done.num_resumed));
  CHECK(read_file(out / "counting.csv") == expected);
}

TEST_CASE("Whatever is cut off or damaged of the finished cells is done again",
          "[experiments][sweep_runner]") {
  const TemporaryFolder folder;
  const std::string expected = undisturbed_table(folder);
  const ExperimentConfig config = config_in(folder);
  const fs::path out = folder.path() / "undisturbed";
  const std::string cells = read_file(out / "counting.cells");
  const std::size_t header = cells.find('\n') + 1;
  const auto run_again = [&](const std::string& text) {
    std::ofstream(out / "counting.cells", std::ios::binary) << text;
    const RunProgress done = run_sweep(counting_experiment(), config, {}, {out, 2});
    CHECK(read_file(out / "counting.csv") == expected);
    return done.num_resumed;
  };
  CHECK(run_again(cells) == 24);
  CHECK(run_again(cells.substr(0, header / 2)) == 0);
  CHECK(run_again(cells.substr(0, header)) == 0);
  CHECK(run_again(cells.substr(0, cells.size() - 1)) == 23);
  CHECK(run_again(cells.substr(0, cells.size() - 40)) == 23);
  std::string damaged = cells;
  damaged[cells.find('\n', header) + 60] ^= 1;  // This is behind the line of the run's start.
  CHECK(run_again(damaged) == 23);
}

TEST_CASE("Data that is missing is skipped, said, and tried again", "[experiments][sweep_runner]") {
  const TemporaryFolder folder;
  const std::string expected = undisturbed_table(folder);
  const ExperimentConfig config = config_in(folder);
  const fs::path out = folder.path() / "results";
  Experiment without = counting_experiment();
  without.run = [run = without.run](const Cell& cell, const fs::path& cells) -> CellResult {
    if (cell.labels[0] == "b") throw MissingData("b.off is not there");
    return run(cell, cells);
  };
  const RunProgress first = run_sweep(without, config, {}, {out, 2});
  CHECK(first.num_skipped == 8);
  CHECK(first.num_done == 16);
  CHECK(lines_of(out / "counting.csv")[9].find(",skipped,b.off is not there,,,") !=
        std::string::npos);
  const RunProgress second = run_sweep(counting_experiment(), config, {}, {out, 2});
  CHECK(second.num_resumed == 16);
  CHECK(second.num_done == 24);
  CHECK(read_file(out / "counting.csv") == expected);
}

TEST_CASE("A run whose cells are all skipped is an error, and a later one makes up for it",
          "[experiments][sweep_runner]") {
  const TemporaryFolder folder;
  const std::string expected = undisturbed_table(folder);
  const ExperimentConfig config = config_in(folder);
  const fs::path out = folder.path() / "results";
  Experiment without = counting_experiment();
  without.run = [](const Cell&, const fs::path&) -> CellResult {
    throw MissingData("b.off is not there; set \"IT\"");
  };
  CHECK_THROWS_WITH(run_sweep(without, config, {}, {out, 2}),
                    "all 24 cells were skipped, so there is no table; the first, letter=a step=0 "
                    "seed=1: b.off is not there; set \"IT\"");
  CHECK_FALSE(fs::exists(out / "counting.csv"));
  // For a shard it is no error that all cells were skipped; for the merged whole it is.
  const fs::path parts = folder.path() / "parts";
  CHECK(run_sweep(without, config, {}, {parts, 1, Shard{1, 1}}).num_skipped == 24);
  CHECK_THROWS_WITH(merge_shards(without, config, {}, parts),
                    graspfit::testing::Contains("all 24 cells were skipped"));
  CHECK(run_sweep(counting_experiment(), config, {}, {out, 2}).num_resumed == 0);
  CHECK(read_file(out / "counting.csv") == expected);
}

TEST_CASE("Cells that failed for a reason that may pass are counted, not published, tried again",
          "[experiments][sweep_runner]") {
  const TemporaryFolder folder;
  const ExperimentConfig config = config_in(folder);
  const fs::path out = folder.path() / "results";
  Experiment crowded = counting_experiment();
  crowded.run = [run = crowded.run](const Cell& cell, const fs::path& cells) -> CellResult {
    if (cell.labels[0] == "a") throw std::bad_alloc();
    if (cell.labels[0] == "b") throw graspfit::base::IoError("no space left");
    return run(cell, cells);
  };
  const RunProgress first = run_sweep(crowded, config, {}, {out, 2});
  CHECK(first.num_failed == 18);  // They are 8 and 8, and 2 for good.
  CHECK(first.num_not_final == 16);
  const fs::path manifest = out / "counting.manifest.json";
  CHECK(nlohmann::json::parse(read_file(manifest)).at("cells").at("not_final") == 16);
  CHECK_THROWS_WITH(require_publishable_manifest(manifest),
                    graspfit::testing::Contains("16 cells failed for a reason that may pass"));
  const RunProgress second = run_sweep(counting_experiment(), config, {}, {out, 1});
  CHECK(second.num_resumed == 8);
  CHECK(second.num_failed == 2);
  CHECK(second.num_not_final == 0);
  CHECK_NOTHROW(require_publishable_manifest(manifest));
  // A manifest may lack their number.
  auto json = nlohmann::json::parse(read_file(manifest));
  json.at("cells").erase("not_final");
  CHECK_NOTHROW(require_publishable_manifest(folder.write("old.json", json.dump())));
}

TEST_CASE("Results of another configuration or another run's folder are not touched",
          "[experiments][sweep_runner]") {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "undisturbed";
  const std::string expected = undisturbed_table(folder);
  const ExperimentConfig other = config_in(folder, {false, {{"base", {"1"}}}});
  CHECK_THROWS_WITH(run_sweep(counting_experiment(), other, {}, {out, 1}),
                    graspfit::testing::Contains("holds results of another configuration"));
  RunManifest rebuilt;
  rebuilt.program = "another";
  CHECK_THROWS_WITH(run_sweep(counting_experiment(), config_in(folder), rebuilt, {out, 1}),
                    graspfit::testing::Contains("holds results of another build"));
  for (const int jobs : {0, -1, 1025, 2000000000}) {
    CHECK_THROWS_WITH(run_sweep(counting_experiment(), config_in(folder), {}, {out, jobs}),
                      graspfit::testing::Contains("must be in [1, 1024]"));
  }
  CHECK(read_file(out / "counting.csv") == expected);

  // A second run starts in the same folder while the first is at work.
  Experiment nested = counting_experiment();
  std::string refusal;
  nested.run = [&](const Cell&, const fs::path&) -> CellResult {
    try {
      run_sweep(counting_experiment(), config_in(folder), {}, {folder.path() / "busy", 1});
    } catch (const graspfit::base::IoError& error) {
      refusal = error.what();
    }
    throw MissingData("nothing");
  };
  CHECK_THROWS_AS(run_sweep(nested, config_in(folder), {}, {folder.path() / "busy", 1}),
                  MissingData);
  CHECK_THAT(refusal, graspfit::testing::Contains("is in use by another run"));
}

TEST_CASE("Neither quick nor modified results are published", "[experiments][sweep_runner]") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(require_publishable(config_in(folder, {true, {}}), source_folder()),
                    graspfit::testing::Contains("--quick"));
  CHECK_THROWS_WITH(
      require_publishable(config_in(folder, {false, {{"letter", {"a"}}}}), source_folder()),
      graspfit::testing::Contains("--set"));
  // A configuration that is not among the sources cannot be published either.
  CHECK_THROWS_WITH(require_publishable(config_in(folder), source_folder()),
                    graspfit::testing::Contains("is not one of"));
}

TEST_CASE("A recorded command is quoted for a shell and names no folder of results",
          "[experiments][run_manifest]") {
  CHECK(recorded_command({"graspfit", "experiment", "run", "counting"}) ==
        "graspfit experiment run counting");
  CHECK(recorded_command({"run", "--out", "/home/me", "--jobs", "2"}) == "run --jobs 2");
  CHECK(recorded_command({"run", "--out=/home/me", "--jobs", "2", "--out"}) == "run --jobs 2");
  CHECK(recorded_command({"--set", "a=1,0.5", "it's", "", "a b", "$HOME", "*"}) ==
        "--set a=1,0.5 'it'\\''s' '' 'a b' '$HOME' '*'");
}

TEST_CASE("Inputs of one name in the data folder and among the sources are told apart",
          "[experiments][sweep_runner]") {
  const TemporaryFolder folder;
  const auto inputs_with = [&](const std::string& data, const std::vector<fs::path>& files) {
    const char* const setting = std::getenv("GRASPFIT_DATA");
    const std::string before = setting != nullptr ? setting : "";
    ::setenv("GRASPFIT_DATA", data.c_str(), 1);
    Experiment experiment = counting_experiment();
    experiment.inputs = [files](const Cell&) { return files; };
    const fs::path out = folder.path() / ("out" + std::to_string(data.size()));
    run_sweep(experiment, config_in(folder), {}, {out, 1});
    if (setting != nullptr) ::setenv("GRASPFIT_DATA", before.c_str(), 1);
    if (setting == nullptr) ::unsetenv("GRASPFIT_DATA");
    const auto manifest = nlohmann::json::parse(read_file(out / "counting.manifest.json"));
    return manifest.at("inputs_sha256").get<std::map<std::string, std::string>>();
  };
  const fs::path data = folder.write("LICENSE", "of meshes");
  const fs::path own = source_folder() / "LICENSE";
  const fs::path other = source_folder() / "CITATION.cff";
  const auto inputs = inputs_with(folder.path().string(), {data, own, other});
  CHECK(inputs.size() == 3);
  CHECK(inputs.at("LICENSE") == graspfit::base::sha256_hex("of meshes"));
  CHECK(inputs.at("sources/LICENSE") == graspfit::base::sha256_hex(read_file(own)));
  CHECK(inputs.count("CITATION.cff") == 1);

  // All files lie in the root of the file system, which is no data folder that others have.
  const auto at_root = inputs_with("/", {data, other});
  CHECK(at_root.count(data.string()) == 1);
  CHECK(at_root.count("CITATION.cff") == 1);
}

TEST_CASE("Inputs are hashed before the first cell and checked after the last",
          "[experiments][sweep_runner]") {
  const TemporaryFolder folder;
  const fs::path input = folder.write("mesh.off", "before");
  const fs::path out = folder.path() / "results";
  Experiment experiment = counting_experiment();
  experiment.inputs = [input](const Cell&) { return std::vector{input}; };
  run_sweep(experiment, config_in(folder), {}, {out, 1});
  const auto manifest = nlohmann::json::parse(read_file(out / "counting.manifest.json"));
  CHECK(manifest.at("inputs_sha256").at(input.string()) == graspfit::base::sha256_hex("before"));

  for (const bool is_removed : {false, true}) {
    const fs::path other = folder.path() / (is_removed ? "removed" : "changed");
    folder.write("mesh.off", "before");
    Experiment meddling = experiment;
    meddling.run = [&, run = experiment.run](const Cell& cell, const fs::path& cells) {
      if (is_removed) fs::remove(input);
      if (!is_removed) folder.write("mesh.off", "after");
      return run(cell, cells);
    };
    CHECK_THROWS_WITH(run_sweep(meddling, config_in(folder), {}, {other, 1}),
                      graspfit::testing::Contains("mesh.off: was " + other.filename().string()));
    CHECK_FALSE(fs::exists(other / "counting.csv"));
    CHECK_FALSE(fs::exists(other / "counting.manifest.json"));
  }
}

}  // namespace test_sweep_runner
