#include <set>

#include "counting_experiment.hpp"
#include "graspfit/experiments/experiment_registry.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"
#include "support/test_data.hpp"

namespace test_experiment_config {

using namespace graspfit::sweep;
using namespace graspfit::experiments;
using graspfit::testing::counting_experiment;
using graspfit::testing::kCountingConfig;
using graspfit::testing::TemporaryFolder;

namespace {

std::string message_of(const std::string& text, const ConfigRequest& request = {}) {
  const TemporaryFolder folder;
  const auto file = folder.write("counting.json", text);
  try {
    read_config(counting_experiment(), file, request);
  } catch (const graspfit::base::Error& error) {
    return error.what();
  }
  return "no error";
}

std::string with(const std::string& old, const std::string& replacement) {
  std::string text = kCountingConfig;
  const std::size_t at = text.find(old);
  REQUIRE(at != std::string::npos);
  return text.replace(at, old.size(), replacement);
}

ExperimentConfig config_of(const ConfigRequest& request = {}) {
  const TemporaryFolder folder;
  return read_config(counting_experiment(), folder.write("counting.json", kCountingConfig),
                     request);
}

}  // namespace

TEST_CASE("A sweep has all combinations, the last axis fastest", "[experiments][config]") {
  const ExperimentConfig config = config_of();
  REQUIRE(config.sweep.num_cells() == 24);
  CHECK(config.sweep.cell(0).key == "letter=a step=0 seed=1");
  CHECK(config.sweep.cell(1).key == "letter=a step=0 seed=2");
  CHECK(config.sweep.cell(2).key == "letter=a step=0.5 seed=1");
  CHECK(config.sweep.cell(23).key == "letter=c step=2 seed=2");
  CHECK(nlohmann::json::parse(config.sweep.cell(23).settings) ==
        nlohmann::json({{"amount", 3}, {"base", 100}, {"step", 2}}));
  CHECK_FALSE(config.is_quick);
  CHECK_FALSE(config.is_modified);
}

TEST_CASE("A cell's seed depends on its axes, not on its place", "[experiments][config]") {
  const ExperimentConfig all = config_of();
  std::set<std::uint64_t> seeds;
  for (std::size_t i = 0; i < all.sweep.num_cells(); ++i) {
    const Cell cell = all.sweep.cell(i);
    CHECK(cell.seed < (std::uint64_t{1} << 53));
    seeds.insert(cell.seed);
  }
  CHECK(seeds.size() == all.sweep.num_cells());

  const ExperimentConfig some = config_of({false, {{"step", {"2", "0.5"}}, {"letter", {"c"}}}});
  REQUIRE(some.sweep.num_cells() == 4);
  CHECK(some.sweep.cell(0).key == all.sweep.cell(22).key);
  CHECK(some.sweep.cell(0).seed == all.sweep.cell(22).seed);

  ParameterSweep swapped = all.sweep;
  std::swap(swapped.axes[0], swapped.axes[1]);
  CHECK(swapped.cell(0).seed == all.sweep.cell(0).seed);
  swapped.base_seed = 8;
  CHECK(swapped.cell(0).seed != all.sweep.cell(0).seed);

  // Published tables state seeds. This one is the SHA-256 of the text as Python's hashlib has it:
  // int(sha256(b'["counting",7,{"letter":"a","seed":"1","step":"0"}]').hexdigest()[:14], 16) >> 3.
  CHECK(all.sweep.cell(0).seed == 5805151507310987);
}

TEST_CASE("Quick and changed configurations say so", "[experiments][config]") {
  const ExperimentConfig quick = config_of({true, {}});
  CHECK(quick.is_quick);
  CHECK(quick.sweep.num_cells() == 4);
  CHECK(nlohmann::json::parse(quick.sweep.cell(0).settings).at("base") == 0);

  const ExperimentConfig added = config_of({false, {{"base", {"1", "2", "3"}}}});
  CHECK(added.is_modified);
  CHECK(added.sweep.num_cells() == 72);
  CHECK(added.sweep.cell(2).key == "letter=a step=0 base=2 seed=1");
  CHECK(added.identity() != quick.identity());
  CHECK(config_of().identity() == config_of().identity());
}

TEST_CASE("Quick may have values of its own beside those of the axis", "[experiments][config]") {
  const auto sweep_with = [](const std::string& picks) {
    const TemporaryFolder folder;
    return read_config(counting_experiment(), folder.write("counting.json", with("[\"b\"]", picks)),
                       {true, {}})
        .sweep;
  };
  const ParameterSweep sweep = sweep_with(R"([{"name": "d", "amount": 9}, "b"])");
  REQUIRE(sweep.axes[0].values.size() == 2);
  CHECK(sweep.axes[0].values[0].label == "b");
  CHECK(nlohmann::json::parse(sweep.cell(4).settings).at("amount") == 9);
  CHECK(sweep_with(R"([{"name": "d", "amount": 9}])").axes[0].values.size() == 1);
  CHECK_THROWS_WITH(
      sweep_with(R"([{"name": "a", "amount": 9}])"),
      graspfit::testing::Contains("/quick/axes/letter/0: is the second value named a"));
}

TEST_CASE("Meshes of the command line need an axis of objects", "[experiments][config]") {
  ConfigRequest request;
  request.object_files = {"mug.obj"};
  CHECK(message_of(kCountingConfig, request) ==
        "--object: counting has no axis object; there are letter, step, seed");
}

TEST_CASE("Configuration errors name file, key and what is allowed", "[experiments][config]") {
  const auto check = [](const std::string& message, const std::vector<std::string>& parts) {
    INFO(message);
    for (const std::string& part : parts) CHECK(message.find(part) != std::string::npos);
    CHECK(message.find('\n') == std::string::npos);
  };
  check(message_of("{"), {"counting.json", "is not JSON"});
  check(message_of("{\"axes\": " + std::string(100000, '[') + std::string(100000, ']') + "}"),
        {"counting.json: line 1, column 73: nests deeper than 64 levels"});
  check(message_of(with("\"cell\"", "\"cel\"")),
        {"counting.json: /cel: ", "there are experiment, question, cell, seed, axes"});
  check(message_of(with("\"cell\": \"Adds.\",", "")), {"counting.json: /cell: is missing"});
  check(message_of(with("\"counting\"", "\"other\"")), {"/experiment: is not counting"});
  check(message_of(with("\"seed\": 7", "\"seed\": -7")),
        {"/seed: is -7, must be an integer from 0"});
  check(message_of(with("\"seeds\": 2", "\"seeds\": 0")), {"/seeds: is 0, must be in [1, 100000]"});
  check(message_of(with("\"amount\": 2", "\"amont\": 2")),
        {"counting.json: /axes/letter/1/amont: is no setting; there are amount, step, base"});
  check(message_of(with("\"amount\": 2", "\"amount\": \"2\"")),
        {"/axes/letter/1/amount: is \"2\", must be a number"});
  check(message_of(with("0.5", "\"half\"")), {"/axes/step/1: is \"half\", must be a number"});
  check(message_of(with("\"base\": 100", "\"base\": []")), {"/settings/base: is []"});
  check(message_of(with("\"name\": \"b\"", "\"name\": \"a\"")),
        {"/axes/letter/1: is the second value named a"});
  check(message_of(with("\"name\": \"b\"", "\"name\": \"b/c\"")), {"letters, digits and _.+-"});
  check(message_of(with("[0, 0.5, 1, 2]", "[]")), {"/axes/step: ", "at least one value"});
  check(message_of(with("\"amount\": 2", "\"step\": 2")),
        {"setting step is set by axis letter and by axis step"});
  check(message_of(with("[\"b\"]", "[\"d\"]"), {true, {}}),
        {"/quick/axes/letter/0: is no value of axis letter; there are a, b, c"});
  check(message_of(kCountingConfig, {false, {{"letter", {"d"}}}}),
        {"--set letter: \"d\" is no value of that axis; there are a, b, c"});
  check(message_of(kCountingConfig, {false, {{"colour", {"red"}}}}),
        {"--set colour: is no setting; there are amount, step, base"});
}

TEST_CASE("An axis can have the values of another configuration's", "[experiments][config]") {
  const TemporaryFolder folder;
  folder.write("other.json", R"({"axes": {"letter": [{"name": "d", "amount": 4},
                                                      {"name": "e", "amount": 5}]}})");
  const auto sweep_with = [&](const std::string& first) {
    return read_config(
               counting_experiment(),
               folder.write("counting.json",
                            with(R"({"name": "a", "amount": 1, "note": "the first"})", first)))
        .sweep;
  };
  const ParameterSweep sweep = sweep_with(R"({"values_of": "other"})");
  REQUIRE(sweep.axes[0].values.size() == 4);
  CHECK(sweep.cell(0).key == "letter=d step=0 seed=1");
  CHECK(nlohmann::json::parse(sweep.cell(8).settings).at("amount") == 5);
  CHECK(sweep.cell(16).key == "letter=b step=0 seed=1");
  const ParameterSweep some = sweep_with(R"({"values_of": "other", "only": ["e"]})");
  CHECK(some.axes[0].values.size() == 3);
  CHECK(some.cell(0).key == "letter=e step=0 seed=1");
  for (const auto& [value, expected] : std::vector<std::pair<std::string, std::string>>{
           {R"({"values_of": "none"})",
            "counting.json: /axes/letter/0/values_of: has no configuration"},
           {R"({"values_of": "other", "only": ["f"]})",
            "/axes/letter/0/only/0: is no value of axis letter; there are d, e"},
           {R"({"values_of": "../other"})", "is not the name of an experiment"},
           {R"({"values_of": "other", "amount": 3})", "/axes/letter/0/amount: "},
           {R"({"values_of": "other"}, {"name": "e", "amount": 1})",
            "/axes/letter/1: is the second value named e"}}) {
    CHECK_THROWS_WITH(sweep_with(value), graspfit::testing::Contains(expected));
  }
}

TEST_CASE("Changes of axes are taken apart to the last character", "[experiments][config]") {
  CHECK(parse_axis_change("a=1,b").values == std::vector<std::string>{"1", "b"});
  for (const char* const text : {"a", "=1", "a=", "a=1,", "a=,1", "a=1,,2"}) {
    INFO(text);
    CHECK_THROWS_AS(parse_axis_change(text), graspfit::base::InvalidInput);
  }
}

TEST_CASE("Every registered experiment has a configuration it can use, quick too",
          "[experiments][config]") {
  for (const Experiment& experiment : all_experiments()) {
    INFO(experiment.slug);
    const auto file =
        graspfit::testing::source_directory() / "experiments/configs" / (experiment.slug + ".json");
    CHECK(read_config(experiment, file).sweep.num_cells() > 0);
    CHECK(read_config(experiment, file, {true, {}}).sweep.num_cells() <= 8);
    std::set<std::string> names;
    for (const Column& column : experiment.columns) {
      CHECK(names.insert(column.name).second);
      CHECK_FALSE(column.meaning.empty());
    }
  }
}

}  // namespace test_experiment_config
