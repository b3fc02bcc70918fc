#include "counting_experiment.hpp"
#include "graspfit/experiments/sweep_runner.hpp"
#include "graspfit/experiments/table_comparison.hpp"
#include "graspfit/geometry/atomic_file.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace graspfit::experiments;
using graspfit::geometry::InvalidInput;
using graspfit::testing::TemporaryFolder;

namespace {

CsvTable table(const std::string& text) { return parse_csv(text, "table.csv"); }

TableComparison compare(const std::string& ours, const std::string& theirs,
                        const ComparisonOptions& options = {}) {
  return compare_tables(table("name,value\n" + ours), table("name,value\n" + theirs), 1, options);
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
  CHECK(are_near("1", "1.0000000001"));  // a number that is whole on one machine
  CHECK_FALSE(are_near("5805151507310987", "5805151507310988"));  // a seed
  CHECK(are_near("1e-17", "-3e-16"));                             // zeros but for rounding
  CHECK_FALSE(are_near("1e-17", "1e-11"));
  CHECK_FALSE(are_near("", "0"));
  CHECK_FALSE(are_near("true", "false"));
  CHECK_FALSE(are_near("index 0.02; palm", "index 0.03; palm"));
  CHECK(compare("a,1.01\n", "a,1\n", {0.02, 0.0}).differences.empty());
  CHECK_THROWS_WITH(compare("", "", {-1.0, 0.0}), Catch::Contains("relative = -1"));
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
  const auto other = folder.path() / "other";
  run_sweep(experiment, config({false, {{"letter", {"a"}}, {"step", {"0"}}, {"seed", {"1", "3"}}}}),
            {}, {other, 1});
  CHECK_THROWS_WITH(compare_with_published(experiment, other, published),
                    "row letter=a step=0 seed=3 is not in the published table");
}
