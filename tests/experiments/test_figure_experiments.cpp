// These tests compare experiments from whose rows pictures are drawn with closed forms, the
// library's own results and one another.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "cells/planning_table.hpp"
#include "graspfit/experiments/experiment_registry.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "support/catch.hpp"

namespace test_figure_experiments {

using namespace graspfit;
using namespace graspfit::sweep;
using namespace graspfit::experiments;

namespace {

using Fields = std::map<std::string, std::string>;

struct Result {
  Fields row;
  std::vector<Fields> details;
};

Fields named(const std::vector<Column>& columns, const std::vector<std::string>& fields) {
  Fields all;
  for (std::size_t i = 0; i < columns.size(); ++i) all[columns[i].name] = fields[i];
  return all;
}

Result run(const std::string& slug, const std::string& settings) {
  const Experiment& experiment = find_experiment(slug);
  const Cell cell{{"cell"}, "case=cell", 7, settings};
  experiment.check(cell);
  const CellResult result = experiment.run(cell, "folder that is never made");
  Result read{named(experiment.columns, result.row.csv_fields()), {}};
  for (const ResultRow& row : result.details) {
    read.details.push_back(named(experiment.details, row.csv_fields()));
  }
  return read;
}

double number(const Fields& fields, const std::string& name) {
  const std::string& text = fields.at(name);
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

std::string contact_json(const std::string& direction, const std::string& weak = "false") {
  return R"({"direction": )" + direction +
         R"(, "boundary_distance_rel": 0.7, "area_rel": 0.4, "weak": )" + weak + "}";
}

std::string contact_set(const std::vector<std::string>& contacts) {
  std::string list;
  for (const std::string& item : contacts) list += (list.empty() ? "" : ", ") + item;
  return R"({"radius_m": 0.04, "pads_of": "barrett", "contact_set": [)" + list + "]}";
}

const std::string kEast = "[1, 0, 0]";
const std::string kNorthWest = "[-0.5, 0.86602540378443865, 0]";
const std::string kSouthWest = "[-0.5, -0.86602540378443865, 0]";

constexpr double kRounding = 1e-9;  // A dozen operations are on numbers near one.

}  // namespace

TEST_CASE("M of contact sets on a ball is what the formulas say",
          "[experiments][measured_contacts]") {
  // Here M1 = 0.7 + 2 * 0.4 = 1.5. An equilateral triple has 30 degrees on its three pairs, so that
  // M2 = 3 (1 - 30/45) = 1. It is regular and centered, so that M3 = 1.
  const Result good =
      run("measured_contacts",
          contact_set({contact_json(kEast), contact_json(kNorthWest), contact_json(kSouthWest)}));
  CHECK(number(good.row, "m1") == Approx(1.5).margin(kRounding));
  CHECK(number(good.row, "m2") == Approx(1.0).margin(kRounding));
  CHECK(number(good.row, "m3") == Approx(1.0).margin(kRounding));
  CHECK(number(good.row, "m") == Approx(1.5).margin(kRounding));
  REQUIRE(good.details.size() == 3);
  CHECK(good.details[0].at("paired_with") == "1 2");
  CHECK(good.details[2].at("paired_with") == "0 1");

  // One of three contacts is on a fragile part, so that a third of M1 is gone.
  const Result fragile =
      run("measured_contacts", contact_set({contact_json(kEast, "true"), contact_json(kNorthWest),
                                            contact_json(kSouthWest)}));
  CHECK(number(fragile.row, "m1") == Approx(1.0).margin(kRounding));
  CHECK(number(fragile.row, "m") == Approx(1.0).margin(kRounding));
  CHECK(number(fragile.details[0], "strength") == 0.0);

  const Result opposite =
      run("measured_contacts", contact_set({contact_json(kEast), contact_json("[-2, 0, 0]")}));
  CHECK(number(opposite.row, "m") == Approx(1.5).margin(kRounding));

  // Central angles of 45 degrees leave 67.5 degrees between line and normal.
  const Result loose =
      run("measured_contacts", contact_set({contact_json(kEast), contact_json("[1, 1, 0]")}));
  CHECK(number(loose.row, "stable_pairs") == 0.0);
  CHECK(number(loose.row, "m") == 0.0);
}

TEST_CASE("Contact sets that make no sense are refused by name",
          "[experiments][measured_contacts]") {
  const auto refused = [](const std::string& settings, const std::string& why) {
    CHECK_THROWS_WITH(run("measured_contacts", settings), testing::Contains(why));
  };
  refused(contact_set({contact_json("[0, 0, 0]")}), "must not be zero");
  refused(R"({"radius_m": 0, "pads_of": "barrett", "contact_set": []})", "must be > 0");
  refused(R"({"radius_m": 1, "pads_of": "barrett"})", "there is no setting contact_set");
  refused(R"({"radius_m": 1, "pads_of": "barrett", "contact_set": [], "size_m": 1})",
          "is no setting");
  // In other experiments these are the planner's hand and a number.
  const std::string known = "is no setting; there are radius_m, pads_of, contact_set";
  refused(R"({"radius_m": 1, "hand": "barrett", "contact_set": []})", known);
  refused(R"({"radius_m": 1, "pads_of": "barrett", "contacts": []})", known);
}

TEST_CASE("Voxels of a ball: signs of distances, scores and normals",
          "[experiments][object_voxels]") {
  const Result ball = run("object_voxels", R"({"shape": "ball", "size_m": 0.08, "hand": "barrett",
      "slice_axis": "y", "weak-thickness-mm": 0, "resolution": 20})");
  std::int64_t partial = 0;
  std::set<std::string> slice_rows;
  for (const Fields& voxel : ball.details) {
    const std::string& voxel_class = voxel.at("class");
    const double distance = number(voxel, "distance_voxels");
    if (voxel_class == "partial") {
      ++partial;
      CHECK(distance == 0.0);
      Eigen::Vector3d point;
      Eigen::Vector3d normal;
      for (int axis = 0; axis < 3; ++axis) {
        const std::string name(1, static_cast<char>('x' + axis));
        point[axis] = number(voxel, "centroid_" + name + "_m");
        normal[axis] = number(voxel, "normal_" + name);
      }
      // The ball is a polyhedron of 5120 faces: its radius is right within half a percent, its
      // normals within two degrees, and what a patch of one voxel turns, 1/10 rad, averages out.
      CHECK(point.norm() == Approx(0.04).epsilon(0.01));
      CHECK(normal.dot(point.normalized()) > 0.99);
      CHECK(number(voxel, "score") > 0.6);  // All of a ball suits contacts.
    } else {
      CHECK((voxel_class == "full" ? distance < 0.0 : distance > 0.0));
      CHECK(voxel.at("j") == ball.row.at("slice"));
      CHECK(voxel.at("score").empty());
    }
    for (const auto& [name, text] : voxel) {
      INFO(name);
      CHECK(text != "-0");
    }
    if (voxel.at("j") == ball.row.at("slice"))
      slice_rows.insert(voxel.at("i") + "," + voxel.at("k"));
  }
  CHECK(partial == static_cast<std::int64_t>(number(ball.row, "partial")));
  CHECK(number(ball.row, "eligible_share") == 1.0);
  CHECK(number(ball.row, "voxel_size_m") == Approx(0.004));
  // The grid has 20 voxels and a margin of 8 on each side.
  CHECK(slice_rows.size() == 36 * 36);

  const Result whole = run("object_voxels", R"({"shape": "ball", "size_m": 0.08, "hand": "barrett",
      "weak-thickness-mm": 0, "resolution": 20})");
  CHECK(static_cast<std::int64_t>(whole.details.size()) == partial);
  CHECK(whole.row.at("slice").empty());
}

TEST_CASE("What methods look at on a ball: samples on it, medial balls that are the ball",
          "[experiments][guidance_models]") {
  const auto model_of = [](const std::string& planner) {
    return run("guidance_models", R"({"shape": "ball", "size_m": 0.08, "hand": "barrett",
        "weak-thickness-mm": 0, "resolution": 10, "gs-samples": 200, "ma-samples": 200,
        "planner": ")" + planner + "\"}");
  };
  const auto point_of = [](const Fields& fields) {
    return Eigen::Vector3d(number(fields, "x_m"), number(fields, "y_m"), number(fields, "z_m"));
  };
  const Result samples = model_of("gs");
  CHECK(number(samples.row, "points") == 200.0);
  REQUIRE(samples.details.size() == 200);
  for (const Fields& sample : samples.details) {
    const Eigen::Vector3d normal(number(sample, "normal_x"), number(sample, "normal_y"),
                                 number(sample, "normal_z"));
    // Faces of the polyhedron lie up to half a percent deeper and are turned by two degrees.
    CHECK(point_of(sample).norm() == Approx(0.04).epsilon(0.01));
    CHECK(normal.dot(point_of(sample).normalized()) > 0.99);
    CHECK(sample.at("radius_m").empty());
    CHECK(sample.at("kind").empty());
  }
  const Result balls = model_of("ma");
  REQUIRE_FALSE(balls.details.empty());
  for (const Fields& ball : balls.details) {
    // Along the sample's normal a center is known to 3 % of the radius; across it the normal's two
    // degrees turn it by 3.5 %.
    CHECK(point_of(ball).norm() < 0.05 * 0.04);
    CHECK(number(ball, "radius_m") == Approx(0.04).epsilon(0.03));
    CHECK(ball.at("kind") == "point");
    CHECK(ball.at("normal_x").empty());
  }
  CHECK(number(balls.row, "balls_point") == number(balls.row, "points"));
  CHECK(number(balls.row, "balls_axis") == 0.0);
}

TEST_CASE("Settings of an experiment's own do not share names with the planner's",
          "[experiments][settings]") {
  // A name has one description in the schema of all configurations.
  for (const Experiment& experiment : all_experiments()) {
    for (const Column& setting : experiment.settings) {
      for (const Column& known : planning_setting_names()) {
        INFO(experiment.slug);
        CHECK(setting.name != known.name);
      }
    }
  }
}

TEST_CASE("Stages of a fitting start open and end at the grasp", "[experiments][fitting_stages]") {
  const std::string settings = R"({"shape": "torus", "size_m": 0.14, "hand": "barrett",
      "contacts": 3, "count": 1, "max-attempts": 3, "resolution": 20, "weak-thickness-mm": 0})";
  const Result stages = run("fitting_stages", settings);
  const internal::Planned planned = internal::plan(planning_settings(settings, 7));
  REQUIRE_FALSE(planned.result.grasps.empty());
  const grasp::Grasp& grasp = planned.result.grasps.front();
  CHECK(number(stages.row, "m") == grasp.quality.m);

  const std::string palm = planned.hand->links.front().name;
  std::map<std::string, Eigen::Vector3d> palm_at;
  std::map<std::string, double> iterations;
  for (const Fields& row : stages.details) {
    if (row.at("link") != palm) continue;
    palm_at[row.at("stage")] = {number(row, "x_m"), number(row, "y_m"), number(row, "z_m")};
    iterations[row.at("stage")] = number(row, "iterations");
  }
  REQUIRE(palm_at.size() == 6);
  CHECK(stages.details.size() == 6 * planned.hand->links.size());
  CHECK((palm_at["grasp"] - grasp.configuration.X_OH.translation()).norm() == 0.0);
  CHECK(iterations["initial"] == 0.0);
  CHECK(iterations["loop_1"] <= iterations["loop_2"]);
  CHECK(iterations["loop_2"] <= iterations["loop_3"]);
  CHECK(iterations["loop_3"] <= iterations["fitted"]);
  // Refinement moves the palm by at most its limit; the loop comes from farther away.
  const double refined = (palm_at["fitted"] - palm_at["grasp"]).norm();
  CHECK(refined == Approx(number(stages.row, "refinement_shift_m")).margin(1e-12));
  CHECK(refined <= planned.settings.options.refinement.largest_shift + 1e-9);
  CHECK((palm_at["initial"] - palm_at["grasp"]).norm() > refined);
}

TEST_CASE("Stages are those of fitting: another planner is refused by name",
          "[experiments][fitting_stages]") {
  for (const std::string planner : {"gs", "ma"}) {
    CHECK_THROWS_WITH(
        run("fitting_stages", R"({"shape": "torus", "size_m": 0.14, "hand": "barrett",
            "contacts": 3, "count": 1, "max-attempts": 3, "resolution": 20,
            "weak-thickness-mm": 0, "planner": ")" +
                                  planner + "\"}"),
        testing::Contains("is \"" + planner + "\", must be one whose hands are fitted to targets"));
  }
}

/// Spearman's rank correlation of the rows that have both numbers, by counting ranks.
double rank_correlation(const std::vector<Fields>& rows, const std::string& a,
                        const std::string& b) {
  std::vector<const Fields*> both;
  for (const Fields& row : rows) {
    if (!row.at(a).empty() && !row.at(b).empty()) both.push_back(&row);
  }
  // From the middle rank.
  const auto rank = [&](const Fields& row, const std::string& name) {
    double below_less_above = 0.0;
    for (const Fields* other : both) {
      if (number(*other, name) < number(row, name)) below_less_above += 0.5;
      if (number(*other, name) > number(row, name)) below_less_above -= 0.5;
    }
    return below_less_above;
  };
  double ab = 0.0;
  double aa = 0.0;
  double bb = 0.0;
  for (const Fields* row : both) {
    ab += rank(*row, a) * rank(*row, b);
    aa += rank(*row, a) * rank(*row, a);
    bb += rank(*row, b) * rank(*row, b);
  }
  return ab / std::sqrt(aa * bb);
}

TEST_CASE("Every candidate of an attempt is looked at, and a row sums them up",
          "[experiments][candidate_prediction]") {
  const std::string settings =
      R"("shape": "torus", "size_m": 0.12, "hand": "barrett", "contacts": 3, "weak-thickness-mm": 0,
         "max-attempts": 2, "count": 2, "candidate-order": "balance", "keep": "strongest", "max-placements": 6,
         "reach_attempts": 1)";
  const Result result = run("candidate_prediction", "{" + settings + "}");
  CHECK(result.row.at("attempts") == "2");
  REQUIRE(result.row.at("candidates") == std::to_string(result.details.size()));
  CHECK(result.details.size() <= 12);
  std::set<std::pair<std::string, std::string>> numbers;
  int num_valid = 0;
  int num_closed = 0;
  for (const Fields& candidate : result.details) {
    numbers.insert({candidate.at("attempt"), candidate.at("start")});
    const bool is_valid = candidate.at("outcome") == "valid";
    CHECK(candidate.at("epsilon").empty() == !is_valid);
    if (!is_valid) continue;
    ++num_valid;
    if (candidate.at("closed") == "1") ++num_closed;
    // What closes within the narrower cones of the squeeze closes within those of epsilon.
    if (number(candidate, "epsilon") > 1e-6) CHECK(candidate.at("closed") == "1");
    CHECK(number(candidate, "target_distance_m") >= 0.0);
  }
  CHECK(numbers.size() == result.details.size());
  CHECK(result.row.at("valid") == std::to_string(num_valid));
  CHECK(result.row.at("closed") == std::to_string(num_closed));
  REQUIRE(num_valid > 2);
  CHECK(number(result.row, "rank_correlation_by_targets") ==
        Approx(rank_correlation(result.details, "targets_epsilon", "epsilon")).margin(1e-9));
  CHECK(number(result.row, "rank_correlation_by_posture") ==
        Approx(rank_correlation(result.details, "posture_epsilon", "epsilon")).margin(1e-9));
  // All sides of 32 sets of three targets: two each.
  CHECK(result.row.at("reach_sides") == "64");
  CHECK_THROWS_AS(run("candidate_prediction", "{" + settings + R"(, "keep": "first"})"),
                  SettingError);
  CHECK_THROWS_AS(run("candidate_prediction", "{" + settings + R"(, "planner": "gs"})"),
                  SettingError);
}

TEST_CASE("Time and quality by contacts: the row sums up the grasps",
          "[experiments][contacts_and_time]") {
  const std::string grip = R"({"shape": "torus", "size_m": 0.14, "hand": "barrett", "contacts": 3,
      "max-attempts": 4, "resolution": 20, "weak-thickness-mm": 0, "accept": "usable", "distinct-rotation-deg": 0,
      "distinct-joints": 0, "distinct-translation-mm": )";
  const Result result = run("contacts_and_time", grip + R"(0, "count": 4})");
  REQUIRE_FALSE(result.details.empty());
  CHECK(number(result.row, "requested") == 3.0);
  for (const std::string name : {"m", "m2", "num_contacts", "stable_pairs"}) {
    double sum = 0.0;
    for (const Fields& grasp : result.details) sum += number(grasp, name);
    CHECK(number(result.row, "mean_" + name) ==
          Approx(sum / static_cast<double>(result.details.size())));
  }
  for (const Fields& grasp : result.details) CHECK(number(grasp, "num_contacts") >= 3.0);
  CHECK_THROWS_WITH(run("contacts_and_time", grip + R"(0, "count": 2})"),
                    testing::Contains("must be at least max-attempts"));
  CHECK_THROWS_WITH(run("contacts_and_time", grip + R"(10, "count": 4})"),
                    testing::Contains("the one with the larger M would stay"));
}

}  // namespace test_figure_experiments
