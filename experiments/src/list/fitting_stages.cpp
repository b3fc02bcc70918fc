// Question: how does the hand get from its open start to the grasp that the planner returns: where
// are its links when the adjustment loop starts, on its way, at its end, and after refinement?
//
// Answered by a row per cell about its best grasp and, in the details, the pose of every link at
// every stage. The loop is run again from the grasp's own targets with smaller and smaller budgets,
// which stops it on its way; the row says how far its end is from the grasp, which is what
// refinement did.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "cells/planning_table.hpp"
#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/grasp/grasp_guidance.hpp"
#include "graspfit/grasp/grasp_planner.hpp"
#include "graspfit/hands/forward_kinematics.hpp"
#include "graspfit/sweep/setting_value.hpp"
#include "list/experiment_list.hpp"

namespace graspfit::experiments::internal {
namespace fitting_stages_parts {
namespace {

/// Where the loop is stopped, in shares of its iterations.
constexpr std::array kShares = {0.25, 0.5, 0.75};

std::vector<sweep::Column> columns() {
  return {{"object_extent_m", "m", "longest edge of the object's bounding box"},
          {"grasps", "1", "distinct grasps found; the following is about the best"},
          {"m", "1", "its M"},
          {"iterations", "1", "of the adjustment loop"},
          {"refinement_shift_m", "m", "from the palm where the loop ends to that of the grasp"},
          {"mean_target_distance_m", "m", "of the fingers' contacts from their targets"}};
}

std::vector<sweep::Column> details() {
  return {{"stage", "", "initial, loop_1 to loop_3, fitted (the loop's end), grasp (refined)"},
          {"iterations", "1", "of the loop up to this stage"},
          {"link", "", "of the hand"},
          {"x_m", "m", "origin of the link's frame in the object's frame"},
          {"y_m", "m", "of the same"},
          {"z_m", "m", "of the same"},
          {"qw", "1", "unit quaternion of the link's rotation"},
          {"qx", "1", "of the same"},
          {"qy", "1", "of the same"},
          {"qz", "1", "of the same"}};
}

void add_stage(const std::string& stage, std::int64_t iterations, const hands::HandModel& hand,
               const hands::HandConfiguration& configuration, std::vector<sweep::ResultRow>& rows) {
  const std::vector<hands::RigidTransform> X_OL = hands::forward_kinematics(hand, configuration);
  for (std::size_t link = 0; link < X_OL.size(); ++link) {
    const Eigen::Vector3d p = X_OL[link].translation();
    const Eigen::Quaterniond q(X_OL[link].linear());
    sweep::ResultRow row(details());
    row.set("stage", stage);
    row.set("iterations", iterations);
    row.set("link", hand.links[link].name);
    row.set("x_m", p.x());
    row.set("y_m", p.y());
    row.set("z_m", p.z());
    row.set("qw", q.w());
    row.set("qx", q.x());
    row.set("qy", q.y());
    row.set("qz", q.z());
    rows.push_back(std::move(row));
  }
}

/// The adjustment loop from the targets of a grasp, as the planner runs it.
class Loop {
 public:
  Loop(const Planned& planned, const grasp::Grasp& grasp)
      : planned_(planned),
        targets_(grasp.targets),
        hand_(*planned.hand, planned.settings.options.fitting.sample_spacing *
                                 planned.object.grid.lattice.voxel_size),
        surroundings_(*planned.hand, surroundings_of(planned.settings)) {}

  grasp::FittingResult fit(const grasp::PalmPlacement& placement,
                           std::optional<int> max_iterations = {}) const {
    const grasp::PlannerOptions& options = planned_.settings.options;
    grasp::FittingOptions fitting = grasp::fitting_options(options);
    if (max_iterations) fitting.max_iterations = *max_iterations;
    const contact::ContactEstimationOptions contact_options{
        .clip_thickness = grasp::clip_thickness(options, planned_.object.grid.lattice.voxel_size),
        .averaging = options.averaging};
    return grasp::fit_hand({hand_, planned_.object, surroundings_, contact_options}, options.style,
                           targets_, placement, fitting);
  }

  /// Returns the palm placement from which the loop ends nearest to the grasp, as the planner does
  /// not record it.
  grasp::PalmPlacement placement(const grasp::Grasp& grasp) const {
    const grasp::PlannerOptions& options = planned_.settings.options;
    std::optional<grasp::PalmPlacement> best;
    double least = std::numeric_limits<double>::infinity();
    for (const grasp::PalmPlacement& side : grasp::palm_placements(
             planned_.object, targets_, options.approach_O, options.approach_angle)) {
      const grasp::FittingResult fitted = fit(side);
      const double difference =
          (fitted.configuration.X_OH.matrix() - grasp.configuration.X_OH.matrix()).norm();
      if (difference >= least) continue;
      least = difference;
      best = side;
    }
    if (!best) {
      throw base::InvalidInput(
          "fitting_stages: no palm placement leads to the best grasp: it has " +
          std::to_string(targets_.contacts.size()) + " targets");
    }
    return *best;
  }

 private:
  const Planned& planned_;
  grasp::TargetContacts targets_;
  grasp::FittingHand hand_;
  grasp::SurroundingsCollision surroundings_;
};

/// Mean distance from their targets of the fingers' contacts that have one [m].
std::optional<double> mean_target_distance(const grasp::Grasp& grasp) {
  std::vector<double> distances = grasp::target_distances(grasp);
  std::erase_if(distances, [](double distance) { return !std::isfinite(distance); });
  return mean(distances);
}

/// Reads the settings and refuses methods without targets, from which the loop could not be run
/// again.
PlanningSettings settings_of(const sweep::Cell& cell) {
  PlanningSettings settings = planning_settings(cell);
  if (!grasp::planning_methods().at(settings.options.planner).has_targets) {
    throw sweep::SettingError("planner", "is \"" + settings.options.planner +
                                             "\", must be one whose hands are fitted to targets");
  }
  return settings;
}

sweep::CellResult run(const sweep::Cell& cell, const std::filesystem::path& folder) {
  const Planned planned = plan(settings_of(cell));
  sweep::CellResult result{sweep::ResultRow(columns()), sweep::ResultRow(planning_timings())};
  fill_planning_timings(planned, result.timings);
  result.row.set("object_extent_m", geometry::longest_extent(planned.object_file->mesh));
  result.row.set("grasps", field(planned.result.grasps.size()));
  if (planned.result.grasps.empty()) return result;

  const grasp::Grasp& grasp = planned.result.grasps.front();
  const Loop loop(planned, grasp);
  const grasp::PalmPlacement placement = loop.placement(grasp);
  const grasp::FittingResult fitted = loop.fit(placement);
  const hands::HandModel& hand = *planned.hand;
  add_stage("initial", 0, hand, fitted.initial, result.details);
  for (std::size_t i = 0; i < kShares.size(); ++i) {
    const int budget = std::max(1, static_cast<int>(kShares[i] * fitted.iterations));
    const grasp::FittingResult part = loop.fit(placement, budget);
    add_stage("loop_" + std::to_string(i + 1), part.iterations, hand, part.configuration,
              result.details);
  }
  add_stage("fitted", fitted.iterations, hand, fitted.configuration, result.details);
  add_stage("grasp", fitted.iterations, hand, grasp.configuration, result.details);

  result.row.set("m", grasp.quality.m);
  result.row.set("iterations", std::int64_t{fitted.iterations});
  result.row.set(
      "refinement_shift_m",
      (fitted.configuration.X_OH.translation() - grasp.configuration.X_OH.translation()).norm());
  result.row.set("mean_target_distance_m", field(mean_target_distance(grasp)));
  write_best_grasps(folder, planned, 1);
  return result;
}

}  // namespace
}  // namespace fitting_stages_parts

sweep::Experiment fitting_stages() {
  using namespace fitting_stages_parts;
  return {.slug = "fitting_stages",
          .columns = columns(),
          .timings = planning_timings(),
          .details = details(),
          .check = [](const sweep::Cell& cell) { settings_of(cell); },
          .run = run,
          .inputs = [](const sweep::Cell& cell) { return planning_inputs(settings_of(cell)); }};
}

}  // namespace graspfit::experiments::internal
