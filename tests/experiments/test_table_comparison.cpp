#include "counting_experiment.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/sweep/run_manifest.hpp"
#include "graspfit/sweep/sweep_runner.hpp"
#include "graspfit/sweep/table_comparison.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_table_comparison {

using namespace graspfit::sweep;
using graspfit::base::InvalidInput;
using graspfit::testing::TemporaryFolder;

namespace {

CsvTable table(const std::string& text) { return parse_csv(text, "table.csv"); }

TableComparison compare(const std::string& ours, const std::string& theirs,
                        const ComparisonOptions& options = {}) {
  return compare_tables(table("name,value\n" + ours), table("name,value\n" + theirs), 1, options);
}

/// Returns the counting experiment with three rows of details a cell and a summary of two rows.
Experiment detailed_experiment() {
  Experiment experiment = graspfit::testing::counting_experiment();
  experiment.details = {{"part", "1", "its number"}};
  experiment.run = [run = experiment.run, columns = experiment.details](
                       const Cell& cell, const std::filesystem::path& folder) {
    CellResult result = run(cell, folder);
    for (std::int64_t part = 0; part < 3; ++part) {
      result.details.emplace_back(columns);
      result.details.back().set("part", part);
    }
    return result;
  };
  const std::vector<Column> summary = {{"half", "1", "its number"}};
  experiment.summaries.push_back(
      {"summary", summary, [summary](const ParameterSweep&, const std::vector<FinishedCell>&) {
         std::vector<ResultRow> rows(2, ResultRow(summary));
         for (std::size_t i = 0; i < rows.size(); ++i) {
           rows[i].set("half", static_cast<std::int64_t>(i));
         }
         return rows;
       }});
  return experiment;
}

/// Takes the last lines from a table, and its hash from the manifest beside it.
void cut(const std::filesystem::path& table, int num_lines) {
  using graspfit::base::read_file;
  using graspfit::base::write_file_atomically;
  std::string text = read_file(table);
  for (int i = 0; i < num_lines; ++i) text.erase(text.rfind('\n', text.size() - 2) + 1);
  write_file_atomically(table, text);
  const auto manifest = table.parent_path() / "counting.manifest.json";
  auto json = nlohmann::json::parse(read_file(manifest));
  json.erase("tables_sha256");
  write_file_atomically(manifest, json.dump());
}

bool are_near(const std::string& ours, const std::string& theirs) {
  return compare("a," + ours + '\n', "a," + theirs + '\n').differences.empty();
}

}  // namespace

TEST_CASE("What csv_line writes is read back", "[experiments][table_comparison]") {
  std::vector<std::string> fields;
  const std::vector<std::string> texts = {"plain", "", "a, b", "say \"no\"", "\"", ",", "1e-9"};
  for (const std::string& text : texts) fields.push_back(csv_field(text));
  const CsvTable read = table(csv_line(fields) + csv_line(fields));
  CHECK(read.columns == texts);
  REQUIRE(read.rows.size() == 1);
  CHECK(read.rows[0] == texts);
  CHECK_THROWS_WITH(table("a,b\n1,2\n1\n"), "table.csv: line 3 has 1 fields instead of 2");
  CHECK_THROWS_AS(table(""), InvalidInput);
}

TEST_CASE("Numbers are compared relatively, counts, seeds and texts exactly",
          "[experiments][table_comparison]") {
  CHECK(are_near("0.5", "0.5"));
  CHECK(are_near("0.5", "0.50000000049"));
  CHECK_FALSE(are_near("0.5", "0.50000000051"));
  CHECK(are_near("-2.5e+20", "-2.5000000001e+20"));
  CHECK_FALSE(are_near("0.5", "-0.5"));
  CHECK(are_near("1", "1.0000000001"));  // The number is whole on one machine.
  CHECK_FALSE(are_near("5805151507310987", "5805151507310988"));  // These are seeds.
  CHECK(are_near("1e-17", "-3e-16"));  // These are zeros but for rounding.
  CHECK_FALSE(are_near("1e-17", "1e-11"));
  CHECK(are_near("-0", "0"));  // These look like integers, and are one number.
  // As doubles these are one number, as integers they are not.
  CHECK_FALSE(are_near("9007199254740993", "9007199254740992"));
  CHECK_FALSE(are_near("", "0"));
  CHECK_FALSE(are_near("true", "false"));
  CHECK_FALSE(are_near("index 0.02; palm", "index 0.03; palm"));
  CHECK(compare("a,1.01\n", "a,1\n", {0.02, 0.0}).differences.empty());
  CHECK_THROWS_WITH(compare("", "", {-1.0, 0.0}), graspfit::testing::Contains("relative = -1"));
}

TEST_CASE("A difference names row, column and both values", "[experiments][table_comparison]") {
  const TableComparison found = compare("b,2.5\na,1.5\n", "a,1.5\nb,2.75\nc,3\n");
  CHECK(found.num_rows == 2);
  CHECK(found.num_not_ours == 1);
  CHECK_FALSE(found.are_same_bytes);
  REQUIRE(found.differences.size() == 1);
  CHECK(found.differences[0].row == "name=b");
  CHECK(found.differences[0].column == "value");
  CHECK(found.differences[0].ours == "2.5");
  CHECK(found.differences[0].theirs == "2.75");

  CHECK(compare("a,1\n", "a,1\n").are_same_bytes);
  const TableComparison near = compare("a,1.5\n", "a,1.5000000003\n");
  CHECK_FALSE(near.are_same_bytes);
  CHECK(near.largest_relative == Approx(2e-10).epsilon(1e-6));

  // Rows of the same labels are told apart by their order.
  const TableComparison repeated = compare("a,1\na,2\n", "a,1\na,3\n");
  REQUIRE(repeated.differences.size() == 1);
  CHECK(repeated.differences[0].row == "name=a row 2");
  CHECK_THROWS_WITH(compare("d,1\n", "a,1\n"), "row name=d is not in the published table");
  CHECK_THROWS_WITH(compare_tables(table("name,speed\n"), table("name\n"), 1),
                    "column speed is not in the published table");
  CHECK_THROWS_WITH(compare_tables(table("name\n"), table("name,speed\n"), 1),
                    "column speed is not in the run's table");
}

TEST_CASE("A run of fewer cells is compared with all that is published",
          "[experiments][table_comparison]") {
  const TemporaryFolder folder;
  const Experiment experiment = graspfit::testing::counting_experiment();
  const auto config = [&](const ConfigRequest& request) {
    return read_config(experiment,
                       folder.write("counting.json", graspfit::testing::kCountingConfig), request);
  };
  const auto published = folder.path() / "published";
  const auto some = folder.path() / "some";
  run_sweep(experiment, config({}), {}, {published, 1});
  run_sweep(experiment, config({false, {{"letter", {"c"}}}}), {}, {some, 1});
  const auto compared = compare_with_published(experiment, some, published);
  REQUIRE(compared.size() == 1);
  CHECK(compared[0].file == "counting.csv");
  CHECK(compared[0].comparison.num_rows == 8);
  CHECK(compared[0].comparison.num_not_ours == 16);
  CHECK(compared[0].comparison.are_same_bytes);
  CHECK(compared[0].comparison.is_equal());
  const auto other = folder.path() / "other";
  run_sweep(experiment, config({false, {{"letter", {"a"}}, {"step", {"0"}}, {"seed", {"1", "3"}}}}),
            {}, {other, 1});
  CHECK_THROWS_WITH(compare_with_published(experiment, other, published),
                    "row letter=a step=0 seed=3 is not in the published table");
}

TEST_CASE("Rows of a run's own cells are not missed in silence",
          "[experiments][table_comparison]") {
  const TemporaryFolder folder;
  const Experiment experiment = detailed_experiment();
  const auto run_into = [&](const std::string& name, const ConfigRequest& request) {
    const auto out = folder.path() / name;
    run_sweep(
        experiment,
        read_config(experiment, folder.write("counting.json", graspfit::testing::kCountingConfig),
                    request),
        {}, {out, 1});
    return out;
  };
  const auto missing_in = [&](const std::vector<PublishedComparison>& tables) {
    std::vector<std::size_t> counts;
    for (const PublishedComparison& table : tables) {
      CHECK(table.comparison.differences.empty());
      CHECK(table.comparison.is_equal() == table.comparison.missing_rows.empty());
      counts.push_back(table.comparison.missing_rows.size());
    }
    return counts;
  };
  using Counts = std::vector<std::size_t>;
  const auto published = run_into("published", {});
  const auto whole = run_into("whole", {});
  const auto some = run_into("some", {false, {{"letter", {"b"}}}});
  CHECK(missing_in(compare_with_published(experiment, whole, published)) == Counts{0, 0, 0});
  // Cells that the run does not have need not be there, and then there is no summary to compare.
  CHECK(missing_in(compare_with_published(experiment, some, published)) == Counts{0, 0});

  cut(some / "counting.details.csv", 4);
  const auto compared = compare_with_published(experiment, some, published);
  CHECK(missing_in(compared) == Counts{0, 4});
  CHECK(compared[1].comparison.missing_rows[0] == "letter=b step=2 seed=1 row 3");
  CHECK_FALSE(compared[1].comparison.are_same_bytes);
  cut(whole / "counting.details.csv", 1);
  cut(whole / "counting.summary.csv", 1);
  CHECK(missing_in(compare_with_published(experiment, whole, published)) == Counts{0, 1, 1});
  cut(whole / "counting.csv", 1);
  CHECK_THROWS_WITH(compare_with_published(experiment, whole, published),
                    graspfit::testing::Contains("counting.csv: has 23 rows for 24 cells"));
}

TEST_CASE("A table that is not the one its manifest was written for is named",
          "[experiments][table_comparison]") {
  const TemporaryFolder folder;
  const Experiment experiment = detailed_experiment();
  const auto config = read_config(
      experiment, folder.write("counting.json", graspfit::testing::kCountingConfig), {});
  for (const char* const name : {"run", "published"}) {
    run_sweep(experiment, config, {}, {folder.path() / name, 1});
  }
  const auto compare_both = [&] {
    return compare_with_published(experiment, folder.path() / "run", folder.path() / "published");
  };
  CHECK(compare_both().size() == 3);
  for (const char* const name : {"run", "published"}) {
    const auto table = folder.path() / name / "counting.details.csv";
    const std::string text = graspfit::base::read_file(table);
    graspfit::base::write_file_atomically(table, text + "a,0,1,3\n");
    CHECK_THROWS_WITH(compare_both(),
                      graspfit::testing::Contains(table.string() + ": is not the table"));
    CHECK_THROWS_WITH(require_tables_of_manifest(folder.path() / name / "counting.manifest.json"),
                      graspfit::testing::Contains("tables_sha256"));
    graspfit::base::write_file_atomically(table, text);
  }
  // A manifest may say nothing of tables.
  cut(folder.path() / "published/counting.timing.csv", 1);
  CHECK(compare_both().size() == 3);
}

}  // namespace test_table_comparison
