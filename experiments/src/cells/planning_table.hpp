#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "graspfit/experiments/planning_settings.hpp"
#include "graspfit/grasp/grasp_planner.hpp"

namespace graspfit::experiments::internal {

/// A planner's run on a cell's object and hand, on one thread.
struct Planned {
  PlanningSettings settings;
  std::shared_ptr<const grasp::ObjectFile> object_file;
  std::shared_ptr<const hands::HandModel> hand;
  grasp::ObjectModel object;
  grasp::PlannerResult result;
  double load_s = 0.0;     ///< Reading object and hand.
  double prepare_s = 0.0;  ///< Building the object's model.
  double plan_s = 0.0;
  std::vector<double> attempt_cpu_s;  ///< Processor time from the planner's start to the end of
                                      ///< each attempt.
  std::optional<double> first_s;      ///< From the planner's start to its first accepted grasp.
};

/// Called for every start that is tried, with the cell's hand and object.
using StartObserver = std::function<void(const grasp::TriedStart&, const hands::HandModel&,
                                         const grasp::ObjectModel&)>;

/// @param observer may be empty. @throws MissingData; as `grasp::prepare_object` and
/// `grasp::plan_grasps`.
Planned plan(const PlanningSettings& settings, const StartObserver& observer = {});

/// Columns about all that a planner's run found, and their values.
std::vector<sweep::Column> planning_columns();
void fill_planning_columns(const Planned& planned, sweep::ResultRow& row);

/// Columns of the time that a planner's run took, and their values.
std::vector<sweep::Column> planning_timings();
void fill_planning_timings(const Planned& planned, sweep::ResultRow& row);

/// The largest of some numbers; empty without any.
std::optional<double> largest(const std::vector<double>& values);
/// The median of some numbers, or the mean of the middle two; empty without any.
std::optional<double> median(std::vector<double> values);
/// The arithmetic mean; empty without any.
std::optional<double> mean(const std::vector<double>& values);
/// The root of the mean squared distance from the mean, with n − 1; empty for fewer than two.
std::optional<double> standard_deviation(const std::vector<double>& values);

/// A field that may be empty.
sweep::Value field(const std::optional<double>& value);
sweep::Value field(std::size_t count);

/// Grasps kept of a cell where its experiment asks for no other number: the goals of the planner's
/// tables are about so many.
inline constexpr std::size_t kGraspsKept = 10;

/// Writes `<folder>/grasps.json` with the best `count` grasps, if there are any. Nothing is written
/// for a shape, which comes from no file: its grasps could not be read back.
void write_best_grasps(const std::filesystem::path& folder, const Planned& planned,
                       std::size_t count);

}  // namespace graspfit::experiments::internal
