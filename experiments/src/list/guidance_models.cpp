// Question: what does each planning method look at to guide hands to an object, the "intermediate
// model" of the paper's Fig. 19: surface samples (GS), balls of the medial axis (MA), score map?
//
// Answered by a row per object and method about its points and, in the details, the points: what
// the pictures of the models are drawn from. The models are those that the planner itself uses.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cells/planning_table.hpp"
#include "graspfit/base/stopwatch.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/grasp/grasp_guidance.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "list/experiment_list.hpp"

namespace graspfit::experiments::internal {
namespace guidance_models_parts {
namespace {

using Clock = std::chrono::steady_clock;

/// A number of the details: its column in the model, and the steps to which it is rounded, far
/// below a voxel.
struct PointNumber {
  sweep::Column column;
  const char* in_model;
  double steps;
};

std::vector<PointNumber> point_numbers() {
  return {
      {{"x_m", "m", "sample, center of a ball or centroid of a voxel's surface; to 1e-6"},
       "x_m",
       1e6},
      {{"y_m", "m", "of the same"}, "y_m", 1e6},
      {{"z_m", "m", "of the same"}, "z_m", 1e6},
      {{"normal_x", "1", "outward normal of a sample or of a voxel's surface; to 1e-4"}, "nx", 1e4},
      {{"normal_y", "1", "of the same"}, "ny", 1e4},
      {{"normal_z", "1", "of the same"}, "nz", 1e4},
      {{"radius_m", "m", "of a ball of the medial axis; to 1e-6"}, "radius_m", 1e6},
      {{"score", "1", "of a voxel; to 1e-4"}, "score", 1e4}};
}

/// What MA found around a ball, in the order of `grasp::SymmetryKind`.
constexpr std::array kKinds = {"alone", "axis", "rim", "interior", "point"};
constexpr const char* kKindInModel = "kind";

std::vector<sweep::Column> columns() {
  std::vector<sweep::Column> all = {
      {"object_extent_m", "m", "longest edge of the object's bounding box"},
      {"points", "1", "samples of gs, balls of ma, voxels of fitting"}};
  for (const char* const kind : kKinds) {
    all.push_back({std::string("balls_") + kind, "1", "of these with that kind of symmetry (ma)"});
  }
  all.push_back({"median_radius_m", "m", "of the balls (ma)"});
  return all;
}

std::vector<sweep::Column> details() {
  std::vector<sweep::Column> all;
  for (const PointNumber& number : point_numbers()) all.push_back(number.column);
  all.push_back({"kind", "", "symmetry around a ball: alone, axis, rim, interior or point (ma)"});
  return all;
}

std::vector<sweep::Column> timings() {
  return {{"prepare_s", "s", "building the object's model; what the cache has of it is read"},
          {"guidance_s", "s", "building the method's own"}};
}

/// A column of a model's rows; empty if it has none of that name.
std::optional<std::vector<double>> values_of(const grasp::GuidanceModel& model,
                                             const std::string& name) {
  const auto found = std::find(model.columns.begin(), model.columns.end(), name);
  if (found == model.columns.end()) return std::nullopt;
  const auto index = static_cast<std::size_t>(found - model.columns.begin());
  std::vector<double> values;
  for (const std::vector<double>& row : model.rows) values.push_back(row[index]);
  return values;
}

std::vector<sweep::ResultRow> point_rows(const grasp::GuidanceModel& model) {
  std::vector<sweep::ResultRow> rows(model.rows.size(), sweep::ResultRow(details()));
  for (const PointNumber& number : point_numbers()) {
    const auto values = values_of(model, number.in_model);
    if (!values) continue;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i].set(number.column.name, std::round((*values)[i] * number.steps) / number.steps + 0.0);
    }
  }
  if (const auto kinds = values_of(model, kKindInModel)) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i].set("kind", kKinds.at(static_cast<std::size_t>((*kinds)[i])));
    }
  }
  return rows;
}

void fill(const grasp::GuidanceModel& model, sweep::ResultRow& row) {
  row.set("points", field(model.rows.size()));
  if (const auto kinds = values_of(model, kKindInModel)) {
    for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
      const auto count = std::count(kinds->begin(), kinds->end(), static_cast<double>(kind));
      row.set(std::string("balls_") + kKinds[kind], static_cast<std::int64_t>(count));
    }
  }
  if (const auto radii = values_of(model, "radius_m")) {
    row.set("median_radius_m", field(median(*radii)));
  }
}

sweep::CellResult run(const sweep::Cell& cell, const std::filesystem::path&) {
  const PlanningSettings settings = planning_settings(cell);
  const std::shared_ptr<const grasp::ObjectFile> file = load_object(settings.object);
  const std::shared_ptr<const hands::HandModel> hand = load_hand(settings.hand);
  sweep::CellResult result{sweep::ResultRow(columns()), sweep::ResultRow(timings())};
  const Clock::time_point start = Clock::now();
  const grasp::ObjectModel object =
      grasp::prepare_object(file->mesh, *hand, settings.options, {.is_on = true});
  result.timings.set("prepare_s", base::seconds_since(start));
  const Clock::time_point guidance_start = Clock::now();
  const grasp::GuidanceModel model =
      grasp::guidance_model(object, *hand, settings.options, surroundings_of(settings));
  result.timings.set("guidance_s", base::seconds_since(guidance_start));
  result.row.set("object_extent_m", geometry::longest_extent(object.mesh()));
  fill(model, result.row);
  result.details = point_rows(model);
  return result;
}

}  // namespace
}  // namespace guidance_models_parts

sweep::Experiment guidance_models() {
  using namespace guidance_models_parts;
  return {
      .slug = "guidance_models",
      .columns = columns(),
      .timings = timings(),
      .details = details(),
      .check = [](const sweep::Cell& cell) { planning_settings(cell); },
      .run = run,
      .inputs = [](const sweep::Cell& cell) { return planning_inputs(planning_settings(cell)); }};
}

}  // namespace graspfit::experiments::internal
