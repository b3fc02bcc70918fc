#include <string>
#include <vector>

#include "cells/method_summary.hpp"
#include "cells/paper_table1.hpp"
#include "cells/planning_table.hpp"
#include "graspfit/experiments/experiment_registry.hpp"
#include "graspfit/sweep/experiment_config.hpp"
#include "support/catch.hpp"
#include "support/test_data.hpp"

namespace test_method_tables {

using namespace graspfit::sweep;
using namespace graspfit::experiments;

namespace {

using Fields = std::vector<std::string>;

std::string refusal(const std::string& members) {
  Cell cell;
  cell.settings = R"({"shape": "ball", "hand": "barrett")" + members + "}";
  try {
    find_experiment("table1").check(cell);
  } catch (const SettingError& error) {
    return error.key() + ": " + error.what();
  }
  return "";
}

const std::vector<Column> kDetails = {{"m", "1", "M"}, {"other", "1", "another measure"}};

const std::vector<Column> kColumns = {
    {"hand", "", "name"}, {"attempts", "1", "attempts"}, {"attempts_rejected", "1", "of these"}};
const std::vector<Column> kLayoutDetails = {{"m", "1", "M"},
                                            {"target_distance_mean", "m", "half of M"},
                                            {"area_share_median", "1", "a tenth"},
                                            {"gap_median_m", "m", "a hundredth"},
                                            {"deepest_overlap_m", "m", "a thousandth"}};

/// Returns rows of `kLayoutDetails`.
std::vector<Fields> grasps(const std::vector<double>& ms) {
  std::vector<Fields> rows;
  for (const double m : ms) {
    rows.emplace_back();
    for (const double share : {1.0, 0.5, 0.1, 0.01, 0.001}) {
      rows.back().push_back(std::to_string(share * m));
    }
  }
  return rows;
}

/// Returns a row of `kColumns`.
Fields counts(int attempts, int rejected) {
  return {"a hand", std::to_string(attempts), std::to_string(rejected)};
}

ParameterSweep sweep_of_methods() {
  ParameterSweep sweep;
  sweep.axes = {{"object", {{"kitten", "{}"}, {"mug", "{}"}}},
                {"size", {{"0.10", "{}"}}},
                {"planner", {{"gs", "{}"}, {"ma", "{}"}, {"fitting", "{}"}}}};
  return sweep;
}

std::string field_of(const ResultRow& row, const std::vector<Column>& columns,
                     const std::string& name) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].name == name) return row.csv_fields()[i];
  }
  FAIL("no column " << name);
  return "";
}

}  // namespace

TEST_CASE("Tables over methods refuse settings that select grasps", "[experiments][methods]") {
  CHECK(refusal(R"(, "search": "first", "planner-seed": 1)").empty());
  CHECK_THAT(refusal(R"(, "search": "best", "planner-seed": 1)"),
             graspfit::testing::StartsWith("search: "));
  CHECK_THAT(refusal(R"(, "search": "first")"),
             graspfit::testing::StartsWith(": there is no setting"));
  CHECK_THAT(refusal(R"(, "search": "first", "planner-seed": -1)"),
             graspfit::testing::StartsWith("planner-seed: is -1"));
  CHECK_THAT(refusal(R"(, "search": "first", "planner-seed": 1, "planner": "none")"),
             graspfit::testing::Contains("fitting|gs-targets|gs|ma|ma-full-retreat"));
}

TEST_CASE("The four tables compare the same methods, but for rejection by M, with the same seed",
          "[experiments][methods]") {
  const auto configs = graspfit::testing::source_directory() / "experiments/configs";
  for (const char* const slug :
       {"table1", "table1_refined", "table1_readings", "table1_all_objects"}) {
    const ParameterSweep sweep =
        read_config(find_experiment(slug), configs / (std::string(slug) + ".json")).sweep;
    const Axis& methods = sweep.axes.back();
    CHECK(methods.name == "planner");
    Fields labels;
    for (const AxisValue& value : methods.values) labels.push_back(value.label);
    Fields expected = {"gs-targets",      "gs",      "ma",
                       "ma-full-retreat", "fitting", "fitting-reject-deviation"};
    // The method that selects by the measure that is averaged is compared only once.
    if (std::string(slug) == "table1") expected.push_back("fitting-reject-m");
    CHECK(labels == expected);
    if (std::string(slug) == "table1_all_objects") continue;
    CHECK(sweep.axes[0].values.size() == 4);
    CHECK(sweep.axes[1].values.size() ==
          (sweep.axes[1].name == "reading" ? std::size_t{19} : std::size_t{3}));
  }
}

TEST_CASE("The paper's figures are its own", "[experiments][methods]") {
  CHECK(internal::paper_table1("bowling_pin", "gs")->quality == 0.96);
  CHECK(internal::paper_table1("bowling_ball", "gs")->time_s == 0.5);
  CHECK(internal::paper_table1("max_planck", "fitting")->quality == 1.22);
  CHECK(internal::paper_table1("kitten", "ma")->quality == 0.92);
  CHECK(internal::paper_table1("kitten", "ma-full-retreat")->time_s == 1.2);
  CHECK(internal::paper_table1("kitten", "gs-targets")->quality == 0.52);
  CHECK(internal::paper_table1("kitten", "fitting-reject-m")->quality == 1.06);
  CHECK_FALSE(internal::paper_table1("mug", "gs"));
  CHECK_FALSE(internal::paper_table1("kitten", "other"));
  for (const char* const object : {"bowling_pin", "max_planck", "kitten"}) {
    CHECK(internal::paper_table1(object, "fitting")->quality >
          internal::paper_table1(object, "ma")->quality);
    CHECK(internal::paper_table1(object, "ma")->quality >
          internal::paper_table1(object, "gs")->quality);
  }
}

TEST_CASE("The summary has a row per method, seeds together, beside the paper's figures",
          "[experiments][methods]") {
  const std::vector<FinishedCell> cells = {
      {{"kitten", "0.10", "gs"}, grasps({0.5, 1.5}), counts(2, 0)},
      {{"kitten", "0.10", "ma"}, grasps({0.25}), counts(1, 0)},
      {{"kitten", "0.10", "fitting"}, grasps({1, 2}), counts(7, 2)},
      {{"kitten", "0.10", "fitting"}, grasps({6}), counts(3, 1)},  // This is another seed.
      {{"mug", "0.10", "gs"}, {}, counts(4, 0)},
  };
  const auto columns = internal::paper_layout_columns();
  const auto rows = internal::paper_layout(kColumns, kLayoutDetails, sweep_of_methods(), cells);
  REQUIRE(rows.size() == 4);
  const auto of = [&](std::size_t row, const std::string& name) {
    return field_of(rows[row], columns, name);
  };
  CHECK(of(0, "object") == "kitten");
  CHECK(of(0, "size") == "0.10");
  CHECK(of(0, "planner") == "gs");
  CHECK(of(0, "hand") == "a hand");
  CHECK(of(0, "grasps") == "2");
  CHECK(of(0, "mean_m") == "1");
  CHECK(std::stod(of(0, "sd_m")) == Approx(std::sqrt(0.5)));
  CHECK(std::stod(of(0, "se_m")) == Approx(0.5));
  CHECK(of(0, "m_per_attempt") == "1");
  CHECK(of(0, "above_gs").empty());
  CHECK(of(1, "sd_m").empty());
  CHECK(of(1, "paper_time_s") == "1.2");
  CHECK(of(1, "above_gs") == "false");
  CHECK(of(2, "grasps") == "3");
  CHECK(of(2, "attempts") == "10");
  CHECK(of(2, "mean_m") == "3");
  CHECK(of(2, "median_m") == "2");
  CHECK(std::stod(of(2, "m_per_attempt")) == Approx(0.9));
  CHECK(std::stod(of(2, "rejected_rate")) == Approx(0.3));
  CHECK(of(2, "paper_m") == "1.06");
  CHECK(std::stod(of(2, "m_over_paper")) == Approx(3 / 1.06));
  CHECK(of(2, "above_ma") == "true");
  CHECK(of(2, "above_gs") == "true");
  CHECK(of(2, "above_ma_full_retreat").empty());
  // The other details are half of M, a tenth, a hundredth and a thousandth of it.
  CHECK(std::stod(of(2, "target_distance_m")) == Approx(1.5));
  CHECK(std::stod(of(2, "area_share_median")) == Approx(0.2));
  CHECK(std::stod(of(2, "gap_median_m")) == Approx(0.02));
  CHECK(std::stod(of(2, "overlap_mean_m")) == Approx(0.003));
  CHECK(std::stod(of(2, "overlap_max_m")) == Approx(0.006));
  CHECK(of(3, "grasps") == "0");
  CHECK(of(3, "mean_m").empty());
  CHECK(of(3, "m_per_attempt") == "0");
  CHECK(of(3, "paper_m").empty());
}

TEST_CASE("Rows and correlations may be told apart by another axis", "[experiments][methods]") {
  ParameterSweep sweep = sweep_of_methods();
  sweep.axes[1] = {"reading", {{"own", "{}"}, {"other", "{}"}}};
  const internal::MethodTableAxes axes{.row = "reading", .group = "reading"};
  const std::vector<FinishedCell> of_readings = {
      {{"kitten", "own", "gs"}, grasps({1, 2}), counts(2, 0)},
      {{"kitten", "other", "gs"}, grasps({1, 4}), counts(2, 0)},
      {{"kitten", "other", "ma"}, grasps({5}), counts(1, 0)},
  };
  const auto rows = internal::paper_layout(kColumns, kLayoutDetails, sweep, of_readings, axes);
  const auto columns = internal::paper_layout_columns(axes);
  REQUIRE(rows.size() == 3);
  CHECK(field_of(rows[0], columns, "reading") == "own");
  CHECK(field_of(rows[0], columns, "mean_m") == "1.5");
  CHECK(field_of(rows[1], columns, "mean_m") == "2.5");
  CHECK(field_of(rows[2], columns, "planner") == "ma");
  CHECK(field_of(rows[2], columns, "above_gs") == "true");

  const std::vector<FinishedCell> cells = {
      {{"kitten", "own", "gs"}, {{"1", "1"}, {"2", "2"}}},
      {{"kitten", "other", "gs"}, {{"1", "2"}, {"4", "1"}}},
      {{"kitten", "other", "ma"}, {{"5", "0"}}},
  };
  const auto agreement = internal::correlations({"m", "other"}, kDetails, sweep, cells, axes);
  REQUIRE(agreement.size() == 3 * 2);  // The groups are all and two readings, the scopes two.
  const auto names = internal::correlation_columns(axes);
  CHECK(field_of(agreement[2], names, "reading") == "own");
  CHECK(field_of(agreement[2], names, "spearman") == "1");
  CHECK(field_of(agreement[4], names, "reading") == "other");
  CHECK(field_of(agreement[4], names, "spearman") == "-1");
}

TEST_CASE("Correlations are of ranks, over all grasps and within cells", "[experiments][methods]") {
  // Within each cell the measures run against each other; over both cells together they do not.
  const std::vector<FinishedCell> cells = {
      {{"kitten", "0.10", "gs"}, {{"1", "2"}, {"2", "1"}, {"3", ""}}},
      {{"mug", "0.10", "gs"}, {{"11", "12"}, {"12", "11"}}},
      {{"mug", "0.10", "ma"}, {{"5", "5"}, {"5", "6"}}},
  };
  const auto columns = internal::correlation_columns();
  const auto rows = internal::correlations({"m", "other"}, kDetails, sweep_of_methods(), cells);
  REQUIRE(rows.size() == 4 * 2);  // The groups are all and three methods, the scopes two.
  const auto value_of = [&](const std::string& method, const std::string& scope) {
    for (const ResultRow& row : rows) {
      if (field_of(row, columns, "planner") == method && field_of(row, columns, "scope") == scope) {
        return field_of(row, columns, "spearman") + " of " + field_of(row, columns, "grasps");
      }
    }
    return std::string("no row");
  };
  // The ranks are 1 2 3 4 against 2 1 4 3: 1 - 6 * 4 / (4 * 15) = 0.6.
  CHECK(std::stod(value_of("gs", "all")) == Approx(0.6));
  CHECK(value_of("gs", "cell") == "-1 of 4");
  CHECK(value_of("ma", "all") == " of 2");  // M is the same for both.
  CHECK(value_of("fitting", "cell") == " of 0");
}

TEST_CASE("A standard deviation is about the mean, with one less", "[experiments][methods]") {
  CHECK_FALSE(internal::standard_deviation({}));
  CHECK_FALSE(internal::standard_deviation({1.0}));
  CHECK(*internal::standard_deviation({1.0, 3.0}) == Approx(std::sqrt(2.0)));
}

}  // namespace test_method_tables
