#include <string>
#include <vector>

#include "graspfit/experiments/experiment_config.hpp"
#include "internal/method_summary.hpp"
#include "internal/paper_table1.hpp"
#include "internal/planning_table.hpp"
#include "support/catch.hpp"
#include "support/test_data.hpp"

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
             graspfit::testing::Contains("fitting|gs|ma|ma-full-retreat"));
}

TEST_CASE("The four tables compare the same methods with the same seed", "[experiments][methods]") {
  const auto configs = graspfit::testing::source_directory() / "experiments/configs";
  for (const char* const slug :
       {"table1", "table1_refined", "table1_readings", "table1_all_objects"}) {
    const ParameterSweep sweep =
        read_config(find_experiment(slug), configs / (std::string(slug) + ".json")).sweep;
    const Axis& methods = sweep.axes.back();
    CHECK(methods.name == "planner");
    Fields labels;
    for (const AxisValue& value : methods.values) labels.push_back(value.label);
    CHECK(labels == Fields{"gs", "ma", "ma-full-retreat", "fitting"});
    CHECK_THAT(sweep.settings, graspfit::testing::Contains("\"planner-seed\":1"));
    if (std::string(slug) == "table1_all_objects") continue;
    CHECK(sweep.axes[0].values.size() == 4);
    CHECK(sweep.axes[1].values.size() ==
          (sweep.axes[1].name == "reading" ? std::size_t{7} : std::size_t{3}));
  }
}

TEST_CASE("The paper's figures are its own", "[experiments][methods]") {
  CHECK(internal::paper_table1("bowling_pin", "gs")->quality == 0.96);
  CHECK(internal::paper_table1("bowling_ball", "gs")->time_s == 0.5);
  CHECK(internal::paper_table1("max_planck", "fitting")->quality == 1.22);
  CHECK(internal::paper_table1("kitten", "ma")->quality == 0.92);
  CHECK(internal::paper_table1("kitten", "ma-full-retreat")->time_s == 1.2);
  CHECK_FALSE(internal::paper_table1("mug", "gs"));
  CHECK_FALSE(internal::paper_table1("kitten", "other"));
  for (const char* const object : {"bowling_pin", "max_planck", "kitten"}) {
    CHECK(internal::paper_table1(object, "fitting")->quality >
          internal::paper_table1(object, "ma")->quality);
    CHECK(internal::paper_table1(object, "ma")->quality >
          internal::paper_table1(object, "gs")->quality);
  }
}

TEST_CASE("The summary has the means of all methods side by side and says which order they have",
          "[experiments][methods]") {
  const std::vector<FinishedCell> cells = {
      {{"kitten", "0.10", "gs"}, {{"0.5", "1"}, {"1.5", "2"}}},
      {{"kitten", "0.10", "ma"}, {{"0.25", "1"}}},
      {{"kitten", "0.10", "fitting"}, {{"1", "1"}, {"2", "2"}, {"6", "3"}}},
      {{"mug", "0.10", "gs"}, {}},
  };
  const auto columns = internal::paper_layout_columns();
  const auto rows = internal::paper_layout(kDetails, sweep_of_methods(), cells);
  REQUIRE(rows.size() == 2);
  const auto of = [&](std::size_t row, const std::string& name) {
    return field_of(rows[row], columns, name);
  };
  CHECK(of(0, "object") == "kitten");
  CHECK(of(0, "gs_grasps") == "2");
  CHECK(of(0, "gs_mean_m") == "1");
  CHECK(std::stod(of(0, "gs_sd_m")) == Approx(std::sqrt(0.5)));
  CHECK(of(0, "ma_sd_m").empty());
  CHECK(of(0, "fitting_mean_m") == "3");
  CHECK(of(0, "fitting_median_m") == "2");
  CHECK(of(0, "fitting_paper_m") == "1.06");
  CHECK(of(0, "ma_paper_time_s") == "1.2");
  CHECK(of(0, "fitting_above_ma") == "true");
  CHECK(of(0, "ma_above_gs") == "false");
  CHECK(of(0, "fitting_above_ma_full_retreat").empty());
  CHECK(of(1, "gs_grasps") == "0");
  CHECK(of(1, "gs_mean_m").empty());
  CHECK(of(1, "gs_paper_m").empty());
  CHECK(of(1, "gs_paper_time_s").empty());
}

TEST_CASE("Rows and correlations may be told apart by another axis", "[experiments][methods]") {
  ParameterSweep sweep = sweep_of_methods();
  sweep.axes[1] = {"reading", {{"own", "{}"}, {"other", "{}"}}};
  const internal::MethodTableAxes axes{.row = "reading", .group = "reading"};
  const std::vector<FinishedCell> cells = {
      {{"kitten", "own", "gs"}, {{"1", "1"}, {"2", "2"}}},
      {{"kitten", "other", "gs"}, {{"1", "2"}, {"4", "1"}}},
      {{"kitten", "other", "ma"}, {{"5", "0"}}},
  };
  const auto rows = internal::paper_layout(kDetails, sweep, cells, axes);
  const auto columns = internal::paper_layout_columns(axes);
  REQUIRE(rows.size() == 2);
  CHECK(field_of(rows[0], columns, "reading") == "own");
  CHECK(field_of(rows[0], columns, "gs_mean_m") == "1.5");
  CHECK(field_of(rows[0], columns, "ma_mean_m").empty());
  CHECK(field_of(rows[1], columns, "gs_mean_m") == "2.5");
  CHECK(field_of(rows[1], columns, "ma_above_gs") == "true");

  const auto agreement = internal::correlations({"m", "other"}, kDetails, sweep, cells, axes);
  REQUIRE(agreement.size() == 3 * 2);  // all and two readings, two scopes
  const auto names = internal::correlation_columns(axes);
  CHECK(field_of(agreement[2], names, "reading") == "own");
  CHECK(field_of(agreement[2], names, "spearman") == "1");
  CHECK(field_of(agreement[4], names, "reading") == "other");
  CHECK(field_of(agreement[4], names, "spearman") == "-1");
}

TEST_CASE("Correlations are of ranks, over all grasps and within cells", "[experiments][methods]") {
  // Within each cell the measures run against each other, over both cells together.
  const std::vector<FinishedCell> cells = {
      {{"kitten", "0.10", "gs"}, {{"1", "2"}, {"2", "1"}, {"3", ""}}},
      {{"mug", "0.10", "gs"}, {{"11", "12"}, {"12", "11"}}},
      {{"mug", "0.10", "ma"}, {{"5", "5"}, {"5", "6"}}},
  };
  const auto columns = internal::correlation_columns();
  const auto rows = internal::correlations({"m", "other"}, kDetails, sweep_of_methods(), cells);
  REQUIRE(rows.size() == 4 * 2);  // all and three methods, two scopes
  const auto value_of = [&](const std::string& method, const std::string& scope) {
    for (const ResultRow& row : rows) {
      if (field_of(row, columns, "planner") == method && field_of(row, columns, "scope") == scope) {
        return field_of(row, columns, "spearman") + " of " + field_of(row, columns, "grasps");
      }
    }
    return std::string("no row");
  };
  // Ranks 1 2 3 4 against 2 1 4 3: 1 - 6 * 4 / (4 * 15) = 0.6.
  CHECK(std::stod(value_of("gs", "all")) == Approx(0.6));
  CHECK(value_of("gs", "cell") == "-1 of 4");
  CHECK(value_of("ma", "all") == " of 2");  // M is the same for both
  CHECK(value_of("fitting", "cell") == " of 0");
}

TEST_CASE("A standard deviation is about the mean, with one less", "[experiments][methods]") {
  CHECK_FALSE(internal::standard_deviation({}));
  CHECK_FALSE(internal::standard_deviation({1.0}));
  CHECK(*internal::standard_deviation({1.0, 3.0}) == Approx(std::sqrt(2.0)));
}
