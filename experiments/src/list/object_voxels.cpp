// Question: what does the planner know of an object before it looks for contacts: which voxels are
// partial and full, where their surface is and which way it faces, how far from the surface the
// others are, how the score comes about, and what is fragile?
//
// Answered by a row per object (how many voxels, how scores are distributed) and, in the details, a
// row per partial voxel and, where a slice is asked for, per voxel of it, through the center of
// mass: what the pictures of voxels, score map and distance map are drawn from.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cells/planning_table.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/sweep/setting_value.hpp"
#include "list/experiment_list.hpp"

namespace graspfit::experiments::internal {
namespace object_voxels_parts {
namespace {

using geometry::VoxelClass;

// Numbers of the details are rounded to these steps: far below a voxel, and half as many digits.
constexpr double kStepsPerMeter = 1e6;
constexpr double kStepsPerUnit = 1e4;
constexpr std::array kAxes = {"x", "y", "z"};

/// Never a negative zero, whose sign is rounding error.
double rounded(double value, double steps) { return std::round(value * steps) / steps + 0.0; }

std::vector<sweep::Column> own_settings() {
  return {{"slice_axis", "", "x, y or z: the details have a slice across it; without: none"}};
}

std::optional<int> slice_axis(const sweep::Cell& cell) {
  const auto axis = sweep::find_setting(cell, own_settings().front().name);
  return axis ? std::optional(sweep::axis_of(*axis)) : std::nullopt;
}

PlanningSettings settings_of(const sweep::Cell& cell) {
  return planning_settings(cell, own_settings());
}

std::vector<sweep::Column> columns() {
  std::vector<sweep::Column> all = {
      {"object_extent_m", "m", "longest edge of the object's bounding box"},
      {"num_vertices", "1", "of the mesh, repaired"},
      {"voxel_size_m", "m", "edge of a voxel"},
  };
  for (const char* const axis : kAxes) {
    all.push_back({std::string("grid_") + axis + "_m", "m", "lowest corner of the grid"});
  }
  for (const char* const axis : kAxes) {
    all.push_back({std::string("mass_center_") + axis + "_m", "m", "center of mass"});
  }
  for (const sweep::Column& column : std::vector<sweep::Column>{
           {"slice", "1", "index of the slice along slice_axis, if there is one"},
           {"partial", "1", "voxels that hold surface"},
           {"full", "1", "voxels inside"},
           {"median_score", "1", "of the partial voxels, after the mean filter"},
           {"eligible_share", "1", "share of partial voxels whose score exceeds the threshold"},
           {"weak_share", "1", "share of partial voxels on fragile features"},
           {"mean_plane_distance_voxels", "voxels", "mean C_d of the partial voxels"},
           {"mean_normal_angle_deg", "deg", "mean C_a of the partial voxels"}}) {
    all.push_back(column);
  }
  return all;
}

std::vector<sweep::Column> details() {
  std::vector<sweep::Column> all = {{"i", "1", "index of the voxel along x"},
                                    {"j", "1", "along y"},
                                    {"k", "1", "along z"},
                                    {"class", "", "empty, partial or full"},
                                    {"distance_voxels", "voxels", "signed distance map"}};
  for (const char* const axis : kAxes) {
    all.push_back(
        {std::string("centroid_") + axis + "_m", "m", "of a partial voxel's surface, to 1e-6"});
  }
  for (const char* const axis : kAxes) {
    all.push_back({std::string("normal_") + axis, "1", "outward, of that surface, to 1e-4"});
  }
  for (const sweep::Column& column :
       std::vector<sweep::Column>{{"plane_distance_voxels", "voxels", "C_d, to 1e-4"},
                                  {"normal_angle_deg", "deg", "C_a, to 1e-4"},
                                  {"score", "1", "after the mean filter, to 1e-4"},
                                  {"weak", "", "whether the surface is on a fragile feature"}}) {
    all.push_back(column);
  }
  return all;
}

std::vector<sweep::Column> timings() {
  return {{"prepare_s", "s", "building the object's model; what the cache has of it is read"}};
}

const char* class_name(VoxelClass voxel_class) {
  switch (voxel_class) {
    case VoxelClass::Empty:
      return "empty";
    case VoxelClass::Partial:
      return "partial";
    case VoxelClass::Full:
      return "full";
  }
  return "";
}

sweep::ResultRow detail_of(const grasp::ObjectModel& object, const Eigen::Vector3i& voxel) {
  sweep::ResultRow row(details());
  row.set("i", std::int64_t{voxel[0]});
  row.set("j", std::int64_t{voxel[1]});
  row.set("k", std::int64_t{voxel[2]});
  row.set("class", class_name(object.grid.at(voxel)));
  row.set("distance_voxels", rounded(object.distance.at(voxel), kStepsPerUnit));
  const auto found = object.patch_in(object.grid.lattice.index(voxel));
  if (!found) return row;
  const std::int32_t index = *found;
  const geometry::SurfacePatch& patch = object.patches[index];
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name = kAxes[axis];
    row.set("centroid_" + name + "_m", rounded(patch.centroid[axis], kStepsPerMeter));
    if (patch.has_normal) {
      row.set("normal_" + name, rounded(patch.outward_normal[axis], kStepsPerUnit));
    }
  }
  const grasp::ContactScoreMap& scores = object.scores;
  row.set("plane_distance_voxels", rounded(scores.mean_plane_distance[index], kStepsPerUnit));
  row.set("normal_angle_deg", rounded(scores.mean_normal_angle_deg[index], kStepsPerUnit));
  row.set("score", rounded(scores.scores[index], kStepsPerUnit));
  if (object.weak) row.set("weak", static_cast<bool>(object.is_weak_patch[index]));
  return row;
}

void fill(const grasp::ObjectModel& object, double threshold, sweep::ResultRow& row) {
  const geometry::VoxelLattice& lattice = object.grid.lattice;
  const std::vector<double>& scores = object.scores.scores;
  const auto share = [&](auto count) {
    return static_cast<double>(count) / static_cast<double>(object.patches.size());
  };
  row.set("object_extent_m", geometry::longest_extent(object.mesh()));
  row.set("num_vertices", field(object.mesh().vertices.size()));
  row.set("voxel_size_m", lattice.voxel_size);
  for (int axis = 0; axis < 3; ++axis) {
    row.set(std::string("grid_") + kAxes[axis] + "_m", lattice.origin[axis]);
    row.set(std::string("mass_center_") + kAxes[axis] + "_m", object.mass.center_of_mass[axis]);
  }
  row.set("partial", object.grid.count(VoxelClass::Partial));
  row.set("full", object.grid.count(VoxelClass::Full));
  row.set("median_score", field(median(scores)));
  row.set("eligible_share", share(std::count_if(scores.begin(), scores.end(),
                                                [&](double score) { return score > threshold; })));
  if (object.weak) {
    const std::vector<bool>& weak = object.is_weak_patch;
    row.set("weak_share", share(std::count(weak.begin(), weak.end(), true)));
  }
  row.set("mean_plane_distance_voxels", field(mean(object.scores.mean_plane_distance)));
  row.set("mean_normal_angle_deg", field(mean(object.scores.mean_normal_angle_deg)));
}

sweep::CellResult run(const sweep::Cell& cell, const std::filesystem::path&) {
  const PlanningSettings settings = settings_of(cell);
  const std::shared_ptr<const grasp::ObjectFile> file = load_object(settings.object);
  const std::shared_ptr<const hands::HandModel> hand = load_hand(settings.hand);
  const auto start = std::chrono::steady_clock::now();
  const grasp::ObjectModel object =
      grasp::prepare_object(file->mesh, *hand, settings.options, {.is_on = true});
  const std::chrono::duration<double> prepare = std::chrono::steady_clock::now() - start;

  sweep::CellResult result{sweep::ResultRow(columns()), sweep::ResultRow(timings())};
  result.timings.set("prepare_s", prepare.count());
  fill(object, settings.options.targets.score_threshold, result.row);
  const geometry::VoxelLattice& lattice = object.grid.lattice;
  const std::optional<int> axis = slice_axis(cell);
  const Eigen::Vector3i center = lattice.voxel_at(object.mass.center_of_mass);
  if (axis) result.row.set("slice", std::int64_t{center[*axis]});
  for (std::int64_t index = 0; index < lattice.num_voxels(); ++index) {
    const Eigen::Vector3i voxel = lattice.voxel(index);
    const bool is_partial = object.grid.at(voxel) == VoxelClass::Partial;
    const bool is_in_slice = axis && voxel[*axis] == center[*axis];
    if (is_partial || is_in_slice) result.details.push_back(detail_of(object, voxel));
  }
  return result;
}

}  // namespace
}  // namespace object_voxels_parts

sweep::Experiment object_voxels() {
  using namespace object_voxels_parts;
  return {.slug = "object_voxels",
          .columns = columns(),
          .timings = timings(),
          .settings = own_settings(),
          .details = details(),
          .check =
              [](const sweep::Cell& cell) {
                slice_axis(cell);
                settings_of(cell);
              },
          .run = run,
          .inputs = [](const sweep::Cell& cell) { return planning_inputs(settings_of(cell)); }};
}

}  // namespace graspfit::experiments::internal
