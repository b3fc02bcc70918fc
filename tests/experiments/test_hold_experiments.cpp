#include <set>

#include "cells/grasp_measures.hpp"
#include "cells/hold_cell.hpp"
#include "graspfit/experiments/experiment_registry.hpp"
#include "graspfit/sweep/experiment_config.hpp"
#include "support/catch.hpp"
#include "support/test_data.hpp"

namespace test_hold_experiments {

using namespace graspfit::sweep;
using namespace graspfit::experiments;
using graspfit::experiments::internal::correlated_measures;

namespace {

std::string refusal(const std::string& members) {
  Cell cell;
  cell.settings = R"({"shape": "ball", "hand": "barrett")" + members + "}";
  try {
    find_experiment("hold_rates").check(cell);
  } catch (const SettingError& error) {
    return error.key() + ": " + error.what();
  }
  return "";
}

std::size_t column(const std::vector<Column>& columns, const std::string& name) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].name == name) return i;
  }
  FAIL("no column " << name);
  return 0;
}

}  // namespace

TEST_CASE("Experiments that hold grasps leave none out", "[experiments][hold]") {
  CHECK(refusal(R"(, "count": 9, "max-attempts": 9, "margins": 2)").empty());
  for (const auto& [members, expected] : std::vector<std::pair<std::string, std::string>>{
           {R"(, "count": 8, "max-attempts": 9, "margins": 2)", "count: must be at least"},
           {R"(, "count": 9, "max-attempts": 9)", ": there is no setting margins"},
           {R"(, "count": 9, "max-attempts": 9, "margins": -1)", "margins: is -1, must be >= 0"},
           {R"(, "count": 9, "max-attempts": 9, "margins": 2, "search": "first")", "search: "},
           {R"(, "count": 9, "max-attempts": 9, "margins": 2, "accept": "usable")", "accept: "}}) {
    CHECK_THAT(refusal(members), graspfit::testing::StartsWith(expected));
  }
}

TEST_CASE("Both experiments test the same hands on all objects of the planner's tables",
          "[experiments][hold]") {
  const auto configs = graspfit::testing::source_directory() / "experiments/configs";
  const auto sweep_of = [&](const std::string& slug) {
    return read_config(find_experiment(slug), configs / (slug + ".json")).sweep;
  };
  const ParameterSweep rates = sweep_of("hold_rates");
  REQUIRE(rates.axes.size() == 2);
  const std::size_t num_objects = sweep_of("planner_paper_objects").axes[0].values.size() +
                                  sweep_of("planner_everyday").axes[0].values.size();
  CHECK(rates.axes[0].values.size() == num_objects);
  CHECK(sweep_of("hold_prediction").axes[1].values.size() == rates.axes[1].values.size());
  std::set<std::string> grips;
  for (const AxisValue& value : rates.axes[1].values) grips.insert(value.label);
  for (const char* const hand : {"barrett", "human", "allegro", "shadow"}) {
    CHECK(grips.count(hand + std::string("_precision")) == 1);
    CHECK(grips.count(hand + std::string("_power")) == 1);
  }
  CHECK(grips.count("gripper_precision") == 1);
}

TEST_CASE("Details and summary have columns of their own", "[experiments][hold]") {
  for (const char* const slug : {"hold_rates", "hold_prediction", "hold_choices", "hold_default",
                                 "from_table", "multidex_objects"}) {
    const Experiment& experiment = find_experiment(slug);
    const std::vector<Column> summary =
        experiment.summaries.empty() ? std::vector<Column>() : experiment.summaries[0].columns;
    for (const auto* const table : {&experiment.details, &summary}) {
      std::set<std::string> names;
      for (const Column& described : *table) {
        CHECK(names.insert(described.name).second);
        CHECK_FALSE(described.meaning.empty());
      }
    }
  }
}

TEST_CASE("The summary says how well a measure predicts, per grip and for all",
          "[experiments][hold]") {
  const Experiment& experiment = find_experiment("hold_prediction");
  ParameterSweep sweep;
  sweep.axes = {{"object", {{"ball", "{}"}, {"mug", "{}"}}},
                {"grip", {{"weak", "{}"}, {"strong", "{}"}}}};
  // M tells held from lost without fault, epsilon is constant, and M1 tells them the wrong way
  // round.
  const auto detail = [&](double m, bool is_held, const std::string& margin) {
    std::vector<std::string> row(experiment.details.size());
    const auto set = [&](const std::string& name, const std::string& text) {
      row[column(experiment.details, name)] = text;
    };
    set("m", csv_field(m));
    set("m1", csv_field(-m));
    set("epsilon", "-1");
    set("normal_stage", is_held ? "held" : "load");
    set("margin_force_n", margin);
    return row;
  };
  const std::vector<FinishedCell> cells = {
      {{"ball", "weak"}, {detail(0.1, false, "0"), detail(0.2, true, "1.5")}},
      {{"ball", "strong"}, {detail(0.3, true, ""), detail(0.4, true, "")}},
      {{"mug", "weak"}, {detail(0.1, false, "0.1"), detail(0.3, true, "2")}},
      {{"mug", "strong"}, {}}};
  const auto rows = experiment.summaries.at(0).rows(sweep, cells);
  // There is a row for each of groups (all and two grips) x targets x measures x scopes.
  CHECK(rows.size() == 3 * 5 * correlated_measures().size() * 2);
  const auto fields_of = [&](const std::vector<std::string>& wanted) {
    for (const ResultRow& row : rows) {
      const std::vector<std::string> fields = row.csv_fields();
      if (std::equal(wanted.begin(), wanted.end(), fields.begin())) {
        return std::vector<std::string>(fields.begin() + 4, fields.end());
      }
    }
    return std::vector<std::string>();
  };
  using Fields = std::vector<std::string>;
  CHECK(fields_of({"all", "normal_held", "m", "all"}) ==
        Fields{"auc", "1", "1", "1", "6", "4", "3"});
  CHECK(fields_of({"weak", "normal_held", "m1", "cell"}) ==
        Fields{"auc", "0", "0", "0", "4", "2", "2"});
  CHECK(fields_of({"strong", "normal_held", "m", "all"}) ==
        Fields{"auc", "", "", "", "2", "2", "1"});
  CHECK(fields_of({"all", "normal_held", "epsilon", "all"}) ==
        Fields{"auc", "", "", "", "6", "4", "3"});
  CHECK(fields_of({"all", "hard_held", "m", "all"}) == Fields{"auc", "", "", "", "0", "0", "0"});
  CHECK(fields_of({"weak", "margin_force_n", "m", "cell"}) ==
        Fields{"spearman", "1", "1", "1", "4", "", "2"});
}

TEST_CASE("The rates' summary has the quartiles of the margins that were searched for",
          "[experiments][hold]") {
  const Experiment& experiment = find_experiment("hold_rates");
  ParameterSweep sweep;
  sweep.axes = {{"object", {{"ball", "{}"}, {"mug", "{}"}}},
                {"grip", {{"weak", "{}"}, {"strong", "{}"}}}};
  const auto detail = [&](const std::string& stage, const std::string& margin) {
    std::vector<std::string> row(experiment.details.size());
    row[column(experiment.details, "normal_stage")] = stage;
    row[column(experiment.details, "margin_force_n")] = margin;
    return row;
  };
  const std::vector<FinishedCell> cells = {
      {{"ball", "weak"}, {detail("load", "0"), detail("held", "")}},
      {{"ball", "strong"}, {detail("held", "2")}},
      {{"mug", "weak"}, {detail("held", "1")}},
      {{"mug", "strong"}, {}}};
  const auto& summary = experiment.summaries.at(0);
  const auto rows = summary.rows(sweep, cells);
  REQUIRE(rows.size() == 3);
  const auto value = [&](std::size_t row, const std::string& name) {
    return rows[row].csv_fields()[column(summary.columns, name)];
  };
  // Of 0, 1 and 2 the quartiles are 0.5, 1 and 1.5; of 0 and 1 they are 0.25, 0.5 and 0.75.
  CHECK(value(0, "grip") == "all");
  CHECK(value(0, "grasps") == "4");
  CHECK(value(0, "normal_held") == "3");
  CHECK(value(0, "margins") == "3");
  CHECK(value(0, "lower_quartile_margin_force_n") == "0.5");
  CHECK(value(0, "median_margin_force_n") == "1");
  CHECK(value(0, "upper_quartile_margin_force_n") == "1.5");
  CHECK(value(1, "grip") == "weak");
  CHECK(value(1, "lower_quartile_margin_force_n") == "0.25");
  CHECK(value(2, "margins") == "1");
  CHECK(value(2, "upper_quartile_margin_force_n") == "2");
  CHECK(value(2, "median_margin_torque_nm").empty());
}

}  // namespace test_hold_experiments
